#pragma once

#include "core/event.h"
#include "core/result.h"
#include "geometry/region.h"

namespace anchord {

/// The region as a prism: an ellipsoid's shadow on the plane as a polygon of 48 sides with its
/// area, between its least and largest height; a prism as it is. Map frame, m.
Region prism_of(const RegionOfInterest& region);

/// Refuses what is no region: numbers that are not finite, a covariance that is not symmetric
/// positive definite in the world's dimensions, a radius that is not above 0, a polygon that
/// crosses itself, heights out of order. `field` goes into the error.
Status check_region(const RegionOfInterest& region, int dims, const std::string& field);

}  // namespace anchord
