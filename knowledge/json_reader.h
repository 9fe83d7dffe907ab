#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "knowledge/configuration.h"

namespace anchord {

/// The values that a number may take.
struct Range {
  double min = -1e15, max = 1e15;
  bool open_min = false, open_max = false;  ///< whether min and max themselves are left out

  bool contains(double x) const {
    return (open_min ? x > min : x >= min) && (open_max ? x < max : x <= max);
  }
  /// "a number in [0, 1)".
  std::string text() const;
};
inline constexpr Range kAnyNumber{};
inline constexpr Range kPositive{0, 1e15, true};
inline constexpr Range kNotNegative{0, 1e15};
inline constexpr Range kRate{0, 1e6};           ///< 1/s
inline constexpr Range kCoordinate{-1e8, 1e8};  ///< m
inline constexpr Range kProbability{0, 1};
inline constexpr Range kBelowCertain{0, 1, false, true};  ///< 0 <= p < 1
inline constexpr Range kAboveImpossible{0, 1, true};      ///< 0 < p <= 1

/// A value of a JSON document that knows its path, and the list where mistakes are put. Every
/// reader returns nothing and notes a mistake where the value is not what it should be.
/// Refers to the document and the list; cheap to copy.
class JsonValue {
 public:
  JsonValue(const nlohmann::json& value, std::string path, ConfigurationMistakes& mistakes)
      : value_(&value), path_(std::move(path)), mistakes_(&mistakes) {}

  const nlohmann::json& json() const { return *value_; }
  const std::string& path() const { return path_; }
  /// The path of a member, there or not.
  std::string path_of(std::string_view key) const;
  void mistake(std::string message) const { mistake_at(path_, std::move(message)); }
  void mistake_at(std::string path, std::string message) const;

  /// Whether this is an object; notes members that are not among `keys`.
  bool object_of(std::initializer_list<const char*> keys) const;
  /// Whether this is an object.
  bool object() const;
  /// Members of an object, by name; none if it is no object (noted).
  std::vector<std::pair<std::string, JsonValue>> members() const;
  /// Elements of an array of at most `most`; none if it is no array (noted).
  std::vector<JsonValue> elements(std::size_t most) const;
  /// A member of an object, if it is there.
  std::optional<JsonValue> find(std::string_view key) const;

  std::optional<double> number(const Range& range = kAnyNumber) const;
  std::optional<int> integer(int min, int max) const;
  std::optional<bool> boolean() const;
  /// A string, at most 200 bytes.
  std::optional<std::string> text() const;
  /// A string of 1 to 100 bytes without control characters.
  std::optional<std::string> name() const;
  /// As many numbers as said.
  std::optional<std::vector<double>> numbers(std::size_t count,
                                             const Range& range = kAnyNumber) const;
  /// Two numbers, the first below the second.
  std::optional<std::pair<double, double>> interval(const Range& range = kAnyNumber) const;
  /// A point of `dims` coordinates; z = 0 in 2-D.
  std::optional<Eigen::Vector3d> point(int dims) const;
  std::optional<std::vector<Eigen::Vector2d>> polygon() const;
  /// A symmetric positive definite matrix of n x n, row-major.
  std::optional<std::vector<double>> covariance(int n) const;
  /// The index of `name` among `known`, which are `what` ("place").
  std::optional<int> index_of(const std::string& name, const std::vector<std::string>& known,
                              const char* what) const;
  /// The same for the name that this string is.
  std::optional<int> one_of(const std::vector<std::string>& known, const char* what) const;

  /// A member that may be left out: `target` changes only if it is there and right.
  void read(const char* key, double& target, const Range& range) const;
  void read(const char* key, int& target, int min, int max) const;
  void read(const char* key, bool& target) const;
  void read(const char* key, std::string& target) const;

 private:
  const nlohmann::json* value_;
  std::string path_;
  ConfigurationMistakes* mistakes_;
};

/// Whether a name may be used as a key, noted if not: JsonValue::name() for keys.
bool check_name(const JsonValue& value, const std::string& name);

}  // namespace anchord
