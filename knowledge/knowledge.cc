#include "knowledge/knowledge.h"

#include <algorithm>
#include <cmath>

namespace anchord {
namespace {

template <typename Named>
int find_named(const std::vector<Named>& all, std::string_view name) {
  const auto found = std::find_if(
      all.begin(), all.end(), [name](const Named& candidate) { return candidate.name == name; });
  return found == all.end() ? -1 : static_cast<int>(found - all.begin());
}

}  // namespace

const char* to_string(BehaviourModel::Kind kind) {
  switch (kind) {
    case BehaviourModel::Kind::kConstantPosition:
      return "constant_position";
    case BehaviourModel::Kind::kConstantVelocity:
      return "constant_velocity";
    case BehaviourModel::Kind::kSomewhere:
      return "somewhere";
  }
  return "";
}

double DetectionProbability::fallen(double range) const {
  constexpr double kLeast = 1e-6;  // a belief is never certain of a detection, or of none
  const double against = (1 - near) / near * std::exp(-per_m * range);
  return std::clamp(1 / (1 + against), kLeast, 1 - kLeast);
}

int Attribute::find(std::string_view symbol) const {
  if (kind == Kind::kScalar) return find_named(predicates, symbol);
  const auto found = std::find(symbols.begin(), symbols.end(), symbol);
  return found == symbols.end() ? -1 : static_cast<int>(found - symbols.begin());
}

int Knowledge::find_place(std::string_view name) const { return find_named(places, name); }

int Knowledge::find_attribute(std::string_view name) const { return find_named(attributes, name); }

int Knowledge::find_class(std::string_view name) const { return find_named(classes, name); }

const Sensor& Knowledge::sensor(std::string_view name) const {
  const int index = find_named(sensors, name);
  return index < 0 ? default_sensor : sensors[static_cast<std::size_t>(index)];
}

Region Knowledge::world() const { return box(bounds_min, bounds_max); }

}  // namespace anchord
