#include "perception/placement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "core/log_probability.h"
#include "geometry/polygon.h"

namespace anchord {

namespace {

constexpr int kRings = 3, kAround = 8;    ///< of places in an ellipsoid
constexpr int kAcross = 8, kUpwards = 3;  ///< in a prism
constexpr double kBeyond = 1.5;           ///< radii of an ellipsoid
constexpr double kBeside = 2;             ///< standard deviations outside a prism

using Kind = RegionOfInterest::Kind;

/// A covariance of the map; in a 2-D world with variance 1 of its own for the height, so that one
/// formula serves both: heights there are all 0, and its determinant is that of the plane.
Eigen::Matrix3d flattened(Eigen::Matrix3d covariance, int dims) {
  if (dims == 3) return covariance;
  covariance.row(2).setZero();
  covariance.col(2).setZero();
  covariance(2, 2) = 1;
  return covariance;
}

Eigen::Matrix3d covariance_of(const RegionOfInterest& region) {
  return Eigen::Map<const Eigen::Matrix3d>(region.covariance.data());
}

Eigen::Vector3d center_of(const RegionOfInterest& region, int dims) {
  return {region.center[0], region.center[1], dims == 3 ? region.center[2] : 0};
}

double distance2(const RegionOfInterest& region, const Gaussian& measured, int dims,
                 double* root_determinant = nullptr) {
  const Eigen::LLT<Eigen::Matrix3d> llt(
      flattened(covariance_of(region) + measured.covariance, dims));
  if (root_determinant) *root_determinant = llt.matrixLLT().diagonal().prod();
  Eigen::Vector3d e = measured.mean - center_of(region, dims);
  if (dims == 2) e.z() = 0;
  return e.dot(llt.solve(e));
}

/// How far a point lies inside a prism's polygon, m; negative outside.
double depth_inside(const RegionOfInterest& region, const Eigen::Vector2d& point) {
  std::vector<cv::Point2f> corners;
  for (const auto& p : region.polygon) {
    corners.emplace_back(static_cast<float>(p[0]), static_cast<float>(p[1]));
  }
  if (corners.size() < 3) return -std::numeric_limits<double>::infinity();
  return cv::pointPolygonTest(corners,
                              {static_cast<float>(point.x()), static_cast<float>(point.y())}, true);
}

bool beside_prism(const RegionOfInterest& region, const Gaussian& measured, int dims) {
  const Eigen::Vector3d deviation = measured.covariance.diagonal().cwiseSqrt();
  const double slack = kBeside * deviation.head<2>().maxCoeff();
  if (depth_inside(region, measured.mean.head<2>()) < -slack) return false;
  const double slack_z = kBeside * deviation.z();
  return dims == 2 ||
         (measured.mean.z() >= region.z[0] - slack_z && measured.mean.z() <= region.z[1] + slack_z);
}

/// Points over an ellipsoid with the normal density there. In space the rings are turned about
/// three axes.
void add_ellipsoid(const RegionOfInterest& region, int dims, std::vector<Placement>& places) {
  const Eigen::Matrix3d root =
      Eigen::LLT<Eigen::Matrix3d>(flattened(covariance_of(region), dims)).matrixL();
  const Eigen::Vector3d center = center_of(region, dims);
  for (int ring = 0; ring <= kRings; ++ring) {
    // Rings of equal width: each stands for an annulus or shell.
    const double r = region.radius * (ring + 0.25) / (kRings + 0.5);
    const double mass = std::exp(-0.5 * r * r) * std::pow(r, dims - 1);
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5 * ring) / kAround;
      const Eigen::Vector2d circle(r * std::cos(angle), r * std::sin(angle));
      for (int axis = 0; axis < (dims == 3 ? 3 : 1); ++axis) {
        Eigen::Vector3d point = Eigen::Vector3d::Zero();
        point[axis] = circle.x();
        point[(axis + 1) % 3] = circle.y();
        places.push_back({center + root * point, mass});
      }
    }
  }
}

void add_prism(const RegionOfInterest& region, int dims, std::vector<Placement>& places) {
  Eigen::Vector2d min = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d max = -min;
  for (const auto& p : region.polygon) {
    min = min.cwiseMin(Eigen::Vector2d(p.data()));
    max = max.cwiseMax(Eigen::Vector2d(p.data()));
  }
  const Eigen::Vector2d step = (max - min) / kAcross;
  for (int i = 0; i < kAcross; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      const Eigen::Vector2d p = min + step.cwiseProduct(Eigen::Vector2d(i + 0.5, j + 0.5));
      if (!(depth_inside(region, p) >= 0)) continue;
      for (int level = 0; level < (dims == 3 ? kUpwards : 1); ++level) {
        const double z = region.z[0] + (region.z[1] - region.z[0]) * (level + 0.5) / kUpwards;
        places.push_back({{p.x(), p.y(), dims == 3 ? z : 0}, 1});
      }
    }
  }
}

double volume_of(const RegionOfInterest& region, int dims) {
  Polygon polygon;
  for (const auto& p : region.polygon) polygon.emplace_back(p[0], p[1]);
  return area_of(polygon) * (dims == 3 ? region.z[1] - region.z[0] : 1);
}

}  // namespace

std::vector<Placement> placements(const std::vector<RegionOfInterest>& regions, int dims) {
  std::vector<Placement> result;
  double all = 0;
  for (const RegionOfInterest& region : regions) {
    std::vector<Placement> places;
    region.kind == Kind::kPrism ? add_prism(region, dims, places)
                                : add_ellipsoid(region, dims, places);
    double sum = 0;
    for (const Placement& place : places) sum += place.weight;
    if (!(sum > 0)) continue;
    for (Placement& place : places) place.weight *= region.p / sum;
    all += region.p;
    result.insert(result.end(), places.begin(), places.end());
  }
  for (Placement& place : result) place.weight /= all;
  return result;
}

bool may_lie_in(const std::vector<RegionOfInterest>& regions, const Gaussian& measured, int dims) {
  return std::any_of(regions.begin(), regions.end(), [&](const RegionOfInterest& region) {
    return region.kind == Kind::kPrism
               ? beside_prism(region, measured, dims)
               : distance2(region, measured, dims) <= std::pow(kBeyond * region.radius, 2);
  });
}

double log_density(const std::vector<RegionOfInterest>& regions, const Gaussian& measured,
                   int dims) {
  double result = kLogZero;
  double all = 0;
  for (const RegionOfInterest& region : regions) {
    all += region.p;
    double log_p = kLogZero;
    if (region.kind == Kind::kPrism) {
      if (beside_prism(region, measured, dims)) log_p = -std::log(volume_of(region, dims));
    } else {
      double root = 0;
      const double d2 = distance2(region, measured, dims, &root);
      log_p = -0.5 * d2 - std::log(root) - 0.5 * dims * std::log(2 * std::numbers::pi);
    }
    result = log_add(result, std::log(region.p) + log_p);
  }
  return result - std::log(all);
}

}  // namespace anchord
