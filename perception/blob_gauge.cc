#include "perception/blob_gauge.h"

#include <algorithm>
#include <cmath>

#include "perception/roi_mask.h"

namespace anchord {

namespace {

constexpr double kBody = 0.7;  ///< share of a body's box that the body fills, a ball's and a box's

constexpr double kNearSide = 0.85, kNearSideDeviation = 0.15;  ///< radii: a ball's to a box's

/// As wide as an object looks on average over all the ways it may be turned.
Body mean_body(const std::array<double, 3>& extent, int dims) {
  Body body = body_of(extent, dims);
  body.radius = (extent[0] + extent[1]) / 4;
  return body;
}

/// Side of the square with as many pixels.
double side(double pixels) { return std::sqrt(pixels); }

double expected_side(const Camera& camera, const Eigen::Vector3d& position, const Body& body) {
  return side(std::max(1.0, kBody * body_box(camera, position, body).area()));
}

/// Variance of the blob's middle, pixels^2. Half of what is missing may be missing on one side.
double middle_variance(double size_px, double filled, const VerifierSettings& settings) {
  const double edge = settings.edge_noise * size_px;
  const double cut = std::max(0.0, 1 - filled) * size_px / 4;
  return settings.pixel_noise * settings.pixel_noise + edge * edge + cut * cut;
}

std::optional<MeasuredBlob> on_ground(const Blob& blob, const Camera& camera,
                                      const std::array<double, 3>& extent,
                                      const VerifierSettings& settings) {
  const double z = extent[2] / 2;
  const auto ground = camera.to_plane(blob.middle, z);
  const double dz = std::max(1e-3, settings.size_deviation * z);
  const auto higher = camera.to_plane(blob.middle, z + dz);
  if (!ground || !higher) return std::nullopt;
  MeasuredBlob result;
  result.position.mean << ground->position, 0;
  const Body body = mean_body(extent, 2);
  const double expected = expected_side(camera, result.position.mean, body);
  result.size_error = std::log(side(blob.pixels) / expected);
  result.filled = blob.pixels / (expected * expected);
  const Eigen::Vector2d by_height = higher->position - ground->position;
  result.position.covariance.topLeftCorner<2, 2>() =
      ground->jacobian * middle_variance(expected, result.filled, settings) *
          ground->jacobian.transpose() +
      by_height * by_height.transpose();
  return result;
}

std::optional<MeasuredBlob> in_space(const Blob& blob, const Camera& camera,
                                     const std::array<double, 3>& extent, double expected_depth,
                                     const VerifierSettings& settings) {
  const Body body = mean_body(extent, 3);
  const auto size_at = [&](double depth) {
    return expected_side(camera, camera.at_depth(blob.middle, depth).position, body);
  };
  MeasuredBlob result;
  double depth, deviation, size_px;
  if (blob.depth > 0) {
    // What is seen is the near side: of a ball 0.71 radii before the middle, of a box all of it.
    depth = blob.depth + kNearSide * body.radius;
    const double noise = settings.depth_noise * blob.depth * blob.depth;
    deviation = std::hypot(noise, kNearSideDeviation * body.radius);
    size_px = size_at(depth);
    result.size_error = std::log(side(blob.pixels) / size_px);
    result.filled = blob.pixels / (size_px * size_px);
  } else {
    size_px = side(blob.pixels);
    depth = expected_depth * size_at(expected_depth) / size_px;
    const double edges = (2 * settings.pixel_noise + settings.edge_noise * size_px) / size_px;
    deviation = depth * std::hypot(settings.size_deviation, edges);
    result.filled = 1;
  }
  const SpacePoint point = camera.at_depth(blob.middle, depth);
  const double variance = middle_variance(size_px, result.filled, settings);
  result.position.mean = point.position;
  result.position.covariance =
      point.jacobian * Eigen::Vector3d(variance, variance, deviation * deviation).asDiagonal() *
      point.jacobian.transpose();
  return result;
}

}  // namespace

std::optional<MeasuredBlob> measure(const Blob& blob, const Camera& camera,
                                    const std::array<double, 3>& extent, double expected_depth,
                                    int dims, const VerifierSettings& settings) {
  return dims == 2 ? on_ground(blob, camera, extent, settings)
                   : in_space(blob, camera, extent, expected_depth, settings);
}

}  // namespace anchord
