#include "api/json_fields.h"

#include <cmath>
#include <limits>

#include "lcmtypes/names.h"

namespace anchord {

bool JsonFields::check_object(const Json& value, const Field& field) {
  return value.is_object() || refuse(field, "must be an object");
}

bool JsonFields::check_array(const Json& value, const Field& field, std::size_t max_size) {
  if (!value.is_array()) return refuse(field, "must be an array");
  return value.size() <= max_size ||
         refuse(field, "must have at most " + std::to_string(max_size) + " elements");
}

bool JsonFields::read(const Json& value, const Field& field, double& out) {
  if (!value.is_number()) return refuse(field, "must be a number");
  out = value.get<double>();
  return std::isfinite(out) || refuse(field, "must be a finite number");
}

bool JsonFields::read(const Json& value, const Field& field, std::int64_t& out) {
  if (!value.is_number_integer()) return refuse(field, "must be an integer");
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (value.is_number_unsigned() && value.get<std::uint64_t>() > kMost) {
    return refuse(field, "is out of range");
  }
  out = value.get<std::int64_t>();
  return true;
}

bool JsonFields::read(const Json& value, const Field& field, std::string& out) {
  if (!value.is_string()) return refuse(field, "must be a string");
  out = value.get<std::string>();
  const char* fault = text_fault(out);
  return !fault || refuse(field, fault);
}

bool JsonFields::read_numbers(const Json& value, const Field& field,
                              std::initializer_list<std::size_t> counts, std::vector<double>& out) {
  if (!value.is_array()) return refuse(field, "must be an array of numbers");
  if (std::find(counts.begin(), counts.end(), value.size()) == counts.end()) {
    std::string list;
    for (const std::size_t count : counts) {
      list += (list.empty() ? "" : " or ") + std::to_string(count);
    }
    return refuse(field, "must have " + list + " numbers");
  }
  out.resize(value.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!read(value[i], field.element(i), out[i])) return false;
  }
  return true;
}

}  // namespace anchord
