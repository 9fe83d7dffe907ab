#include "knowledge/json_reader.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include "knowledge/suggestion.h"

namespace anchord {
namespace {

constexpr std::size_t kMostMistakes = 200;  // more help nobody
constexpr std::size_t kLongestName = 100, kLongestText = 200;
constexpr double kSymmetryTolerance = 1e-9;  // of the largest entry: numbers printed with 10 digits

std::string quoted(const std::string& text) {
  return '"' + (text.size() > kLongestName ? text.substr(0, kLongestName) + "..." : text) + '"';
}

/// "a number": what stands there instead of what should.
std::string described(const nlohmann::json& value) {
  if (value.is_string()) return quoted(value.get_ref<const std::string&>());
  if (value.is_number() || value.is_boolean()) return value.dump();
  return value.is_null() ? "null" : std::string("an ") + value.type_name();
}

bool acceptable_name(const std::string& name) {
  return !name.empty() && name.size() <= kLongestName &&
         std::none_of(name.begin(), name.end(),
                      [](char c) { return std::iscntrl(static_cast<unsigned char>(c)); });
}

constexpr const char* kNameRule = "a name has 1 to 100 bytes and no control characters";

}  // namespace

std::string Range::text() const {
  std::ostringstream out;
  if (max >= kAnyNumber.max && min <= kAnyNumber.min) return "a number";
  if (max >= kAnyNumber.max) {
    out << "a number " << (open_min ? "above " : "of at least ") << min;
  } else {
    out << "a number in " << (open_min ? '(' : '[') << min << ", " << max << (open_max ? ')' : ']');
  }
  return out.str();
}

std::string JsonValue::path_of(std::string_view key) const {
  const bool plain = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
  });
  if (!plain) return path_ + '[' + quoted(std::string(key)) + ']';
  return path_.empty() ? std::string(key) : path_ + '.' + std::string(key);
}

void JsonValue::mistake_at(std::string path, std::string message) const {
  if (mistakes_->size() < kMostMistakes)
    mistakes_->push_back({std::move(path), std::move(message)});
}

bool JsonValue::object() const {
  if (value_->is_object()) return true;
  mistake("must be an object {...}, not " + described(*value_));
  return false;
}

bool JsonValue::object_of(std::initializer_list<const char*> keys) const {
  if (!object()) return false;
  const std::vector<std::string> known(keys.begin(), keys.end());
  for (const auto& member : value_->items()) {
    if (mistakes_->size() >= kMostMistakes) break;
    if (std::find(known.begin(), known.end(), member.key()) == known.end()) {
      mistake_at(path_of(member.key()), "no such key; " + suggestion(member.key(), known));
    }
  }
  return true;
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::members() const {
  std::vector<std::pair<std::string, JsonValue>> all;
  if (!object()) return all;
  for (const auto& member : value_->items()) {
    all.emplace_back(member.key(), JsonValue(member.value(), path_of(member.key()), *mistakes_));
  }
  return all;
}

std::vector<JsonValue> JsonValue::elements(std::size_t most) const {
  std::vector<JsonValue> all;
  if (!value_->is_array()) {
    mistake("must be an array [...], not " + described(*value_));
  } else if (value_->size() > most) {
    mistake("has " + std::to_string(value_->size()) + " entries; at most " + std::to_string(most) +
            " are possible");
  } else {
    for (std::size_t i = 0; i < value_->size(); ++i) {
      all.emplace_back((*value_)[i], path_ + '[' + std::to_string(i) + ']', *mistakes_);
    }
  }
  return all;
}

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
  if (!value_->is_object()) return std::nullopt;
  const auto member = value_->find(std::string(key));
  if (member == value_->end()) return std::nullopt;
  return JsonValue(*member, path_of(key), *mistakes_);
}

std::optional<double> JsonValue::number(const Range& range) const {
  if (value_->is_number()) {
    const double x = value_->get<double>();
    if (range.contains(x)) return x;
  }
  mistake("must be " + range.text() + ", not " + described(*value_));
  return std::nullopt;
}

std::optional<int> JsonValue::integer(int min, int max) const {
  if (value_->is_number()) {
    const double x = value_->get<double>();
    if (x >= min && x <= max && x == std::floor(x)) return static_cast<int>(x);
  }
  mistake("must be a whole number from " + std::to_string(min) + " to " + std::to_string(max) +
          ", not " + described(*value_));
  return std::nullopt;
}

std::optional<bool> JsonValue::boolean() const {
  if (value_->is_boolean()) return value_->get<bool>();
  mistake("must be true or false, not " + described(*value_));
  return std::nullopt;
}

std::optional<std::string> JsonValue::text() const {
  if (value_->is_string() && value_->get_ref<const std::string&>().size() <= kLongestText) {
    return value_->get<std::string>();
  }
  mistake("must be a string of at most 200 bytes, not " + described(*value_));
  return std::nullopt;
}

std::optional<std::string> JsonValue::name() const {
  if (value_->is_string() && acceptable_name(value_->get_ref<const std::string&>())) {
    return value_->get<std::string>();
  }
  mistake("must be a name, not " + described(*value_) + "; " + kNameRule);
  return std::nullopt;
}

std::optional<std::vector<double>> JsonValue::numbers(std::size_t count, const Range& range) const {
  if (!value_->is_array() || value_->size() != count) {
    mistake("must be an array of " + std::to_string(count) + " numbers, not " +
            (value_->is_array() ? "of " + std::to_string(value_->size()) : described(*value_)));
    return std::nullopt;
  }
  std::vector<double> all;
  for (const JsonValue& element : elements(count)) {
    if (const auto x = element.number(range)) all.push_back(*x);
  }
  if (all.size() != count) return std::nullopt;
  return all;
}

std::optional<std::pair<double, double>> JsonValue::interval(const Range& range) const {
  const auto both = numbers(2, range);
  if (!both) return std::nullopt;
  if ((*both)[0] < (*both)[1]) return std::make_pair((*both)[0], (*both)[1]);
  mistake("must be [least, most] with least below most");
  return std::nullopt;
}

std::optional<Eigen::Vector3d> JsonValue::point(int dims) const {
  const auto x = numbers(static_cast<std::size_t>(dims), kCoordinate);
  if (!x) return std::nullopt;
  return Eigen::Vector3d((*x)[0], (*x)[1], dims == 3 ? (*x)[2] : 0);
}

std::optional<std::vector<Eigen::Vector2d>> JsonValue::polygon() const {
  std::vector<Eigen::Vector2d> points;
  const std::vector<JsonValue> corners = elements(kMaxPolygonPoints);
  for (const JsonValue& corner : corners) {
    if (const auto point = corner.point(2)) points.emplace_back(point->x(), point->y());
  }
  if (!value_->is_array() || points.size() != value_->size()) return std::nullopt;
  const Status checked = check_polygon(points, path_);
  if (checked.ok()) return points;
  mistake_at(checked.error().field.empty() ? path_ : checked.error().field,
             checked.error().message);
  return std::nullopt;
}

std::optional<std::vector<double>> JsonValue::covariance(int n) const {
  const auto entries = numbers(static_cast<std::size_t>(n * n));
  if (!entries) return std::nullopt;
  const Eigen::Map<const Eigen::MatrixXd> matrix(entries->data(), n, n);
  const double scale = matrix.cwiseAbs().maxCoeff();
  const bool symmetric =
      (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= kSymmetryTolerance * scale;
  if (!symmetric || matrix.llt().info() != Eigen::Success) {
    mistake(
        "must be a symmetric positive definite covariance, row-major, such as a diagonal of "
        "variances above 0");
    return std::nullopt;
  }
  return entries;
}

std::optional<int> JsonValue::index_of(const std::string& name,
                                       const std::vector<std::string>& known,
                                       const char* what) const {
  const auto found = std::find(known.begin(), known.end(), name);
  if (found != known.end()) return static_cast<int>(found - known.begin());
  if (mistakes_->size() >= kMostMistakes) return std::nullopt;  // suggestions take time
  mistake(std::string("no ") + what + " is called " + quoted(name) + "; " +
          suggestion(name, known));
  return std::nullopt;
}

std::optional<int> JsonValue::one_of(const std::vector<std::string>& known,
                                     const char* what) const {
  const auto name = text();
  return name ? index_of(*name, known, what) : std::nullopt;
}

void JsonValue::read(const char* key, double& target, const Range& range) const {
  if (const auto member = find(key)) target = member->number(range).value_or(target);
}

void JsonValue::read(const char* key, int& target, int min, int max) const {
  if (const auto member = find(key)) target = member->integer(min, max).value_or(target);
}

void JsonValue::read(const char* key, bool& target) const {
  if (const auto member = find(key)) target = member->boolean().value_or(target);
}

void JsonValue::read(const char* key, std::string& target) const {
  if (const auto member = find(key)) target = member->text().value_or(target);
}

bool check_name(const JsonValue& value, const std::string& name) {
  if (acceptable_name(name)) return true;
  value.mistake(kNameRule);
  return false;
}

}  // namespace anchord
