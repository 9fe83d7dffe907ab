#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/result.h"
#include "lcmtypes/field.h"

namespace anchord {

/// Reads typed values out of JSON. Every step returns whether it went well; the first that does
/// not leaves its error, which names the field.
class JsonFields {
 public:
  using Json = nlohmann::json;

  /// Only after a step that did not go well.
  const Error& error() const { return *error_; }

 protected:
  bool refuse(const Field& field, std::string message) {
    if (!error_) error_ = invalid(field.text(), std::move(message));
    return false;
  }

  bool check_object(const Json& value, const Field& field);
  bool check_array(const Json& value, const Field& field, std::size_t max_size);

  /// A finite number.
  bool read(const Json& value, const Field& field, double& out);
  bool read(const Json& value, const Field& field, std::int64_t& out);
  /// Text as text_fault() allows it.
  bool read(const Json& value, const Field& field, std::string& out);
  /// As many numbers as one of `counts`.
  bool read_numbers(const Json& value, const Field& field,
                    std::initializer_list<std::size_t> counts, std::vector<double>& out);
  template <std::size_t n>
  bool read(const Json& value, const Field& field, std::array<double, n>& out) {
    std::vector<double> numbers;
    if (!read_numbers(value, field, {n}, numbers)) return false;
    std::copy(numbers.begin(), numbers.end(), out.begin());
    return true;
  }

  /// A member of an object, or nullptr where there is none.
  static const Json* find(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
  }
  /// As find(), and its absence is refused.
  const Json* need(const Json& object, const Field& field, const char* key) {
    const Json* found = find(object, key);
    if (!found) refuse(field.member(key), "is missing");
    return found;
  }

 private:
  std::optional<Error> error_;
};

}  // namespace anchord
