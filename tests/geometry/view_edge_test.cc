// How the mass in view changes with the mean, and so the moments of the part in view.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "geometry/view.h"
#include "tests/geometry/sampling.h"

namespace anchord {
namespace {

View random_view(Sampler& sampler, View::Type type) {
  View view;
  view.type = type;
  view.hfov = sampler.uniform(0.2, 2.8);
  view.vfov = sampler.uniform(0.2, 2.2);
  view.range = {sampler.normal() > 0 ? sampler.uniform(0.2, 2.5) : 0, sampler.uniform(3, 8)};
  view.bearing[0] = sampler.uniform(-4, 4);
  view.bearing[1] = view.bearing[0] + sampler.uniform(0.3, 7);  // at times the whole circle
  view.elevation[0] = sampler.uniform(-1.5, 0.8);
  view.elevation[1] = view.elevation[0] + sampler.uniform(0.2, 1.5);
  view.points = {{0.5, -2}, {4, -1}, {2, 0}, {5, 3}, {0, 2}};
  return view;
}

struct Scene {
  MapView view;
  Gaussian density;
};

/// Random views, poses tilted every way, densities of all shapes near and around the sensor.
Scene random_scene(Sampler& sampler, View::Type type, int dims, double widest) {
  const View view = random_view(sampler, type);
  const Eigen::Vector3d position(sampler.uniform(-3, 3), sampler.uniform(-3, 3),
                                 sampler.uniform(-1, 1));
  const Pose pose = exact_pose(position, sampler.orientation());
  Gaussian density{position, sampler.covariance(0.1, widest, dims)};
  density.mean += 3 * Eigen::Vector3d(sampler.normal(), sampler.normal(), sampler.normal());
  if (dims == 2) density.mean.z() = 0;
  return {*MapView::place(view, pose, dims), density};
}

/// What the part in view adds to the first moment and, less the identity, to the second, where the
/// density is standard normal: by the derivatives, and summed over a grid of points.
struct Moments {
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double mass = 0;
};

Moments by_derivatives(const Scene& scene, const Eigen::Matrix3d& root) {
  const MassDerivatives derivatives = scene.view.mass_derivatives(scene.density);
  return {root.transpose() * derivatives.gradient, root.transpose() * derivatives.hessian * root};
}

Moments by_points(const Scene& scene, const Eigen::Matrix3d& root, int dims) {
  const double step = dims == 2 ? 0.02 : 0.12;
  const int n = static_cast<int>(5.2 / step), up = dims == 3 ? n : 0;
  const double cell = std::pow(step / std::sqrt(2 * kPi), dims);
  Moments sum;
  for (int a = -n; a <= n; ++a)
    for (int b = -n; b <= n; ++b)
      for (int c = -up; c <= up; ++c) {
        const Eigen::Vector3d white(step * c, step * a, step * b);
        const double bell = std::exp(-white.squaredNorm() / 2);
        if (bell < 1e-7 || !scene.view.contains(scene.density.mean + root * white)) continue;
        sum.mass += cell * bell;
        sum.first += cell * bell * white;
        sum.second += cell * bell * (white * white.transpose() - Eigen::Matrix3d::Identity());
      }
  if (dims == 2) sum.second.row(0).setZero(), sum.second.col(0).setZero();  // root's axis of none
  return sum;
}

/// `tolerance`: of the lesser of what is in view and what is not. It is the grid's own.
void compare_with_points(View::Type type, int dims, unsigned seed, double tolerance) {
  Sampler sampler(seed);
  int cut = 0;
  for (int i = 0; i < 60; ++i) {
    const Scene scene = random_scene(sampler, type, dims, i % 3 ? 1 : 4);
    const Eigen::Matrix3d root = root_of(scene.density.covariance);
    const Moments found = by_derivatives(scene, root), points = by_points(scene, root, dims);
    const double rest = std::min(points.mass, 1 - points.mass);
    cut += rest > 1e-3;
    EXPECT_LT((found.first - points.first).norm(), tolerance * (rest + 0.005)) << "scene " << i;
    EXPECT_LT((found.second - points.second).norm(), 3 * tolerance * (rest + 0.005))
        << "scene " << i;
  }
  EXPECT_GT(cut, 15) << "too few densities lie on the edge of their view";
}

TEST(ViewEdge, OfSectorsGivesTheMomentsOfTheirPointsIn2D) {
  compare_with_points(View::Type::kSector, 2, 1, 0.03);
}
TEST(ViewEdge, OfFrustumsGivesTheMomentsOfTheirPointsIn2D) {
  compare_with_points(View::Type::kFrustum, 2, 2, 0.03);
}
TEST(ViewEdge, OfPolygonsGivesTheMomentsOfTheirPointsIn2D) {
  compare_with_points(View::Type::kPolygon, 2, 3, 0.03);
}
TEST(ViewEdge, OfSectorsGivesTheMomentsOfTheirPointsIn3D) {
  compare_with_points(View::Type::kSector, 3, 4, 0.1);
}
TEST(ViewEdge, OfFrustumsGivesTheMomentsOfTheirPointsIn3D) {
  compare_with_points(View::Type::kFrustum, 3, 5, 0.1);
}
TEST(ViewEdge, OfPolygonsGivesTheMomentsOfTheirPointsIn3D) {
  compare_with_points(View::Type::kPolygon, 3, 6, 0.1);
}

/// A density that goes from inside a view to outside: without jumps, and as its mass does.
TEST(ViewEdge, IsHowTheMassChangesAcrossIt) {
  Sampler sampler(7);
  for (const auto type : {View::Type::kSector, View::Type::kFrustum, View::Type::kPolygon})
    for (const int dims : {2, 3})
      for (int scene = 0; scene < 4; ++scene) {
        View view = random_view(sampler, type);
        view.elevation = {-0.4, 0.4};
        const MapView placed = *MapView::place(view, std::nullopt, dims);
        Gaussian density{{0, 0, 0}, sampler.covariance(0.1, 0.3, dims)};
        const double bearing = view.bearing[0] + 0.1, h = 0.01;  // m
        const Eigen::Vector3d along(std::cos(bearing), std::sin(bearing), 0), step = h * along;
        for (density.mean = 2 * along; density.mean.norm() < 9; density.mean += step) {
          Gaussian next = density;
          next.mean += step;
          Gaussian middle = density;
          middle.mean += step / 2;
          const double change = (placed.mass(next) - placed.mass(density)) / h;
          // A gradient is at most 0.4 / 0.1 m; the difference has up to 2e-6 / h, and 0.02 covers
          // the mass's third derivative.
          EXPECT_NEAR(placed.mass_derivatives(middle).gradient.dot(along), change, 0.02)
              << "at " << density.mean.norm();
        }
      }
}

TEST(ViewEdge, IsNoneWhereNothingIsCut) {
  const Eigen::Matrix3d covariance = 0.01 * Eigen::Matrix3d::Identity();
  View view;
  view.range = {0.5, 10};
  view.bearing = {-1, 1};
  view.elevation = {-0.5, 0.5};
  view.hfov = view.vfov = 1;
  for (const int dims : {2, 3})
    for (const auto type :
         {View::Type::kNone, View::Type::kWorld, View::Type::kSector, View::Type::kFrustum})
      for (const double x : {5.0, -5.0, 13.0}) {
        view.type = type;
        const MapView placed = *MapView::place(view, std::nullopt, dims);
        EXPECT_TRUE(placed.mass_derivatives({{x, 0, 0}, covariance}).gradient.isZero(0));
        EXPECT_TRUE(placed.mass_derivatives({{x, 0, 0}, covariance}).hessian.isZero(0));
      }
}

}  // namespace
}  // namespace anchord
