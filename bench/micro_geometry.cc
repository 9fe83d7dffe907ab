// What geometry costs: masses of densities in views and regions, conversions into the map.

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "geometry/conversion.h"
#include "geometry/gaussian_mass.h"
#include "geometry/view.h"

namespace anchord::bench {
namespace {

/// A density of 0.3 m about (x, y, 1).
Gaussian density_at(double x, double y) {
  Gaussian density;
  density.mean = {x, y, 1};
  density.covariance = 0.09 * Eigen::Matrix3d::Identity();
  density.covariance(0, 1) = density.covariance(1, 0) = 0.03;
  return density;
}

Pose uncertain_pose() {
  Pose pose;
  pose.position = {0.5, -0.25, 1.2};
  pose.orientation = {std::cos(0.4), 0, 0, std::sin(0.4)};  // heading 0.8
  for (int i = 0; i < 36; i += 7) pose.covariance[i] = 1e-3;
  return pose;
}

View view_of(View::Type type) {
  View view;
  view.type = type;
  view.range = {0.3, 5};
  view.bearing = {-0.5, 0.5};
  view.elevation = {-0.25, 0.25};
  view.hfov = 1;
  view.vfov = 0.75;
  view.points = {{0, 0}, {4, -3}, {6, 0}, {4, 3}};
  return view;
}

/// The density lies across the edge of the view: nothing can be skipped.
void BM_ViewMass(benchmark::State& state, View::Type type) {
  const int dims = static_cast<int>(state.range(0));
  const MapView view = MapView::place(view_of(type), std::nullopt, dims).value();
  const Gaussian density = density_at(4.9, 0.2);
  for (auto _ : state) benchmark::DoNotOptimize(view.mass(density));
}
BENCHMARK_CAPTURE(BM_ViewMass, sector, View::Type::kSector)->Arg(2)->Arg(3);
BENCHMARK_CAPTURE(BM_ViewMass, frustum, View::Type::kFrustum)->Arg(2)->Arg(3);
BENCHMARK_CAPTURE(BM_ViewMass, polygon, View::Type::kPolygon)->Arg(2)->Arg(3);

void BM_RegionMass(benchmark::State& state) {
  const int dims = static_cast<int>(state.range(0));
  Region region;
  for (int i = 0; i < 12; ++i) {
    const double angle = 2 * std::numbers::pi * i / 12;
    region.polygon.emplace_back(3 * std::cos(angle), 2 * std::sin(angle));
  }
  region.z_min = 0.5;
  region.z_max = 1.1;
  const Gaussian density = density_at(2.8, 0.2);
  for (auto _ : state) benchmark::DoNotOptimize(mass(density, region, dims));
}
BENCHMARK(BM_RegionMass)->Arg(2)->Arg(3);

void BM_CartesianToMap(benchmark::State& state) {
  const CartesianMeasurement measurement{{1, 0.2, 0.9}, {1e-3, 0, 0, 0, 1e-3, 0, 0, 0, 2e-3}};
  const std::optional<Pose> pose = uncertain_pose();
  for (auto _ : state) benchmark::DoNotOptimize(to_map(measurement, pose, 3));
}
BENCHMARK(BM_CartesianToMap);

void BM_PolarToMap(benchmark::State& state) {
  const PolarMeasurement measurement{2.5, 0.1, -0.2, {1e-4, 1e-4, 1e-4}};
  const std::optional<Pose> pose = uncertain_pose();
  for (auto _ : state) benchmark::DoNotOptimize(to_map(measurement, pose, 3));
}
BENCHMARK(BM_PolarToMap);

}  // namespace
}  // namespace anchord::bench
