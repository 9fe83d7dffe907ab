#pragma once

#include <optional>
#include <string>
#include <vector>

#include "anchoring/background.h"
#include "anchoring/belief.h"
#include "core/event.h"
#include "core/result.h"
#include "geometry/gaussian.h"

namespace anchord {

/// An event, checked and resolved against the knowledge: what the engine folds.
struct MapEvent {
  Event event;
  std::int64_t number = 0;     ///< among all that the world has taken, from 1: what an undo names
  int place = -1;              ///< index, if it names one
  std::optional<Gaussian> at;  ///< where the object is, if the event says so, map frame
  const Sensor* sensor = nullptr;  ///< kMissing: that looked, in the Background
  std::vector<Region> looked_at;   ///< kMissing: regions of interest as prisms
};

/// Checks everything about an event that does not depend on the belief. Refuses what cannot be
/// believed, naming the field as in JSON (api/event_json.h): numbers that are not finite, a
/// covariance that is not symmetric positive definite, an unknown place, members that its kind
/// needs and that are missing, an alias that looks like a name which the program gives.
Result<MapEvent> place_in_map(const Event& event, const Background& background);

/// Whether an alias could be the name of an anchor, now or later: `cup-12`, `new-3`.
bool looks_like_a_name(const std::string& alias, const Knowledge& knowledge);

/// Whether the event fits the belief that it meets. kUnknown: no anchor is called so, nothing with
/// that number can be undone; kConflict: an alias that another anchor has, an object that is joined
/// with itself, an undo before that of a later event about the same objects.
Status check_against(const MapEvent& event, const Belief& belief);

/// Where an anchor that is called so (its id or alias) stands in a belief.
struct AnchorPlace {
  std::size_t cluster = 0;  ///< index into Belief::clusters
  int anchor = 0;           ///< index into Cluster::anchors
};
std::optional<AnchorPlace> find_anchor(const Belief& belief, std::string_view called);
std::optional<AnchorPlace> find_anchor(const Belief& belief, std::uint64_t birth);

/// Folds an event into the belief, at the belief's time. One that does not fit changes nothing: a
/// late frame may have changed what it was accepted for.
void fold(Belief& belief, const MapEvent& event, const Background& background);

}  // namespace anchord
