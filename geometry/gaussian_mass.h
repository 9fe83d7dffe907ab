#pragma once

#include "geometry/gaussian.h"
#include "geometry/region.h"

namespace anchord {

/// The probability that a point drawn from `density` lies in `region`, in [0, 1].
/// 2-D: exact up to rounding, by Owen's T function over the edges of the polygon in whitened
/// coordinates. 3-D: that, integrated over z by adaptive Gauss quadrature (error below 1e-9).
/// A singular covariance is treated as its limit: a point in or out.
double mass(const Gaussian& density, const Region& region, int dims);

}  // namespace anchord
