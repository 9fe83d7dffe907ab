#include "anchoring/map_event.h"

#include <algorithm>

#include "core/time.h"
#include "geometry/conversion.h"
#include "geometry/region_of_interest.h"

namespace anchord {
namespace {

using Kind = Event::Kind;

/// How far an object may be from the robot that holds it: within its arms' reach; and how well it
/// is known where one is that is told without a covariance. m^2.
constexpr double kReach = 0.25, kTold = 0.01;

/// Longest alias, bytes.
constexpr std::size_t kLongestAlias = 128;

/// Where the event says that the object is. A robot that carries it tells of itself.
Result<Gaussian> position_in_map(const Event& event, int dims) {
  const bool of_robot = event.kind == Kind::kCarried;
  const double untold = event.kind == Kind::kGrasped ? kReach : of_robot ? 0.0 : kTold;
  CartesianMeasurement told;
  for (int i = 0; i < dims; ++i) {
    told.position.push_back((*event.position)[i]);
    for (int j = 0; j < dims; ++j)
      told.covariance.push_back(
          (event.covariance ? (*event.covariance)[3 * i + j] : (i == j ? untold : 0.0)) +
          (of_robot && i == j ? kReach : 0.0));
  }
  return to_map(told, std::nullopt, dims);
}

/// Whether an alias can be told from a name and stands in a line.
Status check_alias(const std::string& alias, const Knowledge& knowledge) {
  if (alias.size() > kLongestAlias) return invalid("name", "must have at most 128 bytes");
  for (const unsigned char c : alias)
    if (c < 0x20 || c == 0x7f) return invalid("name", "must not hold control characters");
  if (looks_like_a_name(alias, knowledge))
    return invalid("name", "must not look like the names that objects are given, such as cup-12");
  return Done{};
}

}  // namespace

bool looks_like_a_name(const std::string& alias, const Knowledge& knowledge) {
  const std::size_t dash = alias.rfind('-');
  if (dash == std::string::npos || dash + 1 == alias.size() ||
      alias.find_first_not_of("0123456789", dash + 1) != std::string::npos)
    return false;
  const std::string stem = alias.substr(0, dash);
  return stem == "new" || std::any_of(knowledge.classes.begin(), knowledge.classes.end(),
                                      [&](const ObjectClass& c) { return c.name == stem; });
}

Result<MapEvent> place_in_map(const Event& event, const Background& background) {
  if (event.utime < kEarliestUtime || event.utime > kLatestUtime)
    return invalid("utime", "must lie in the years 2000 to 2100, in microseconds since 1970");
  const bool of_nothing = event.kind == Kind::kUndone || event.kind == Kind::kCarried;
  if (event.object.empty() && !of_nothing) return invalid("object", "must name an object");
  MapEvent out{event, 0, -1, std::nullopt, nullptr, {}};
  if (!event.place.empty()) {
    out.place = background.knowledge.find_place(event.place);
    if (out.place < 0) return invalid("place", "'" + event.place + "' is not a configured place");
  }
  if (event.covariance && !event.position)
    return invalid("covariance", "says nothing without a position");
  if (event.position) {
    const auto at = position_in_map(event, background.dims);
    if (!at) return at.error();
    out.at = *at;
  }
  switch (event.kind) {
    case Kind::kMissing:
      if (event.sensor.empty()) return invalid("sensor", "must name the sensor that looked");
      out.sensor = &background.knowledge.sensor(event.sensor);
      if (event.regions.empty()) return invalid("regions", "must say where it was looked for");
      if (event.regions.size() > kMaxRegions) return invalid("regions", "must be at most 256");
      for (std::size_t i = 0; i < event.regions.size(); ++i) {
        const std::string field = "regions[" + std::to_string(i) + "]";
        if (Status good = check_region(event.regions[i], background.dims, field); !good)
          return good.error();
        out.looked_at.push_back(prism_of(event.regions[i]));
      }
      break;
    case Kind::kCarried:
      if (!event.position) return invalid("position", "must say where the robot is");
      break;
    case Kind::kNamed:
      if (Status good = check_alias(event.other, background.knowledge); !good) return good.error();
      break;
    case Kind::kJoined:
      if (event.other.empty()) return invalid("other", "must name the object that is the same");
      break;
    default:
      break;
  }
  return out;
}

}  // namespace anchord
