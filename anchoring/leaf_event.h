#pragma once

#include <map>
#include <vector>

#include "anchoring/leaf.h"
#include "anchoring/map_event.h"

namespace anchord {

/// What of a place was looked at, once for all leaves.
class LookedAt {
 public:
  /// The event must outlive it.
  explicit LookedAt(const MapEvent& missing) : regions_(missing.looked_at) {}

  /// Per cell of a footprint the share that was looked at.
  const CellShares& of(const Footprint& footprint);

 private:
  const std::vector<Region>& regions_;
  std::map<const Footprint*, CellShares> shares_;
};

/// What events do to one version of an object; the leaf is predicted to the event's time.

/// It is at a told position, at rest as far as is known.
void put_at(Leaf& leaf, const Gaussian& at, const Background& background);

/// It was put down where it is: at rest as far as is known.
void rest(Leaf& leaf, const Background& background);

/// It is somewhere in a place, anywhere alike; -1: wherever its class may be somewhere (the world,
/// unless configured). It is found by its next detection; until then its tracked models, of weight
/// 0, have the place's moments.
void put_somewhere(Leaf& leaf, int place, const Background& background);

/// It was looked for where it was believed to be, and not found (thesis section 3.6): its tracked
/// mass times the sensor's p_D moves to `somewhere` (several: in proportion to their rates),
/// uniform over its place except where it was looked for (by cells, see Somewhere); r stays. What
/// was somewhere already becomes less there, as after a miss. Of what was said to be in another
/// place than its class's, the share that would have been seen moves likewise, and the rest is
/// tracked by its moments. A held object stays held. Where all of its class's place was looked at,
/// it cannot be elsewhere: nothing changes.
void lose(Leaf& leaf, const Sensor& sensor, LookedAt& looked_at, const Background& background);

/// Two leaves that are said to be of one object: that which is held tells where it is, else that
/// which was seen last (a tie: `a`); classes and attributes are what both have seen; it exists
/// unless neither does.
Leaf fuse(const Leaf& a, const Leaf& b, const Background& background);

}  // namespace anchord
