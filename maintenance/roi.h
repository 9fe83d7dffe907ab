#pragma once

#include <vector>

#include "anchoring/reading.h"
#include "core/event.h"

namespace anchord {

/// Where to look for an object: regions that together hold at least the share `p` of its density,
/// given that it exists. One ellipsoid for one Gaussian; in general, for the greatest level at
/// which it suffices, of each component what lies above that level: ellipsoids of Gaussians, cells
/// of `somewhere` as prisms (joined along rows; the place itself where all its cells belong, or
/// where they would be too many). The regions' own `p` are each of its own component, so the union
/// holds at least their sum. At most kMaxRegions: of very many Gaussians the 64 heaviest.
std::vector<RegionOfInterest> regions_of(const ObjectBelief& object, const Background& background,
                                         double p = 0.95);

/// What is believed of its looks, the class left out: attributes of the leaf that stands for it.
std::vector<AttributeReport> appearance_of(const ObjectBelief& object,
                                           const Background& background);

}  // namespace anchord
