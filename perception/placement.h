#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/event.h"
#include "geometry/gaussian.h"

namespace anchord {

/// One place where an object may be.
struct Placement {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, map frame
  double weight = 0;  ///< probability; over all regions they sum to 1
};

/// Places all over the regions, each with the share of the predicted density that it stands for:
/// normal inside an ellipsoid, uniform inside a prism.
std::vector<Placement> placements(const std::vector<RegionOfInterest>& regions, int dims);

/// Whether a measured position may be one in the regions, or a little beside them: within 1.5 radii
/// of an ellipsoid by the covariances of both (of 95 % in the plane that is 99.8 %), inside a prism
/// or within two standard deviations of it.
bool may_lie_in(const std::vector<RegionOfInterest>& regions, const Gaussian& measured, int dims);

/// ln of the density (per m^dims) of a measured position, were the object distributed as the
/// regions say; kLogZero without regions.
double log_density(const std::vector<RegionOfInterest>& regions, const Gaussian& measured,
                   int dims);

}  // namespace anchord
