#include "perception/roi_mask.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace anchord {

namespace {

constexpr double kLeastDepth = 0.1;  ///< m; nearer is as good as behind the camera
constexpr double kFarthestPx = 1e6;  ///< from the picture's corner; farther overflows
constexpr int kAround = 12;          ///< corners of what stands for a region's circles
constexpr int kAroundBody = 8;       ///< and a body's
constexpr int kPieces = 4;           ///< of straight edges, which lenses bend
constexpr int kMarginPx = 1;         ///< for what is left of that, and for rounding

/// A corner of a regular polygon about the unit circle.
Eigen::Vector2d corner(int i, int corners) {
  const double angle = 2 * std::numbers::pi * i / corners;
  return Eigen::Vector2d(std::cos(angle), std::sin(angle)) / std::cos(std::numbers::pi / corners);
}

void add_prism(const RegionOfInterest& region, int dims, std::vector<Eigen::Vector3d>& points) {
  const std::size_t n = region.polygon.size();
  const int levels = dims == 3 ? kPieces : 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d from(region.polygon[i].data()), to(region.polygon[(i + 1) % n].data());
    for (int piece = 0; piece < kPieces; ++piece) {
      const Eigen::Vector2d p = from + (to - from) * piece / kPieces;
      for (int level = 0; level <= levels; ++level) {
        const double share = static_cast<double>(level) / kPieces;
        const double z = region.z[0] + share * (region.z[1] - region.z[0]);
        points.emplace_back(p.x(), p.y(), dims == 3 ? z : 0);
      }
    }
  }
}

void add_ellipsoid(const RegionOfInterest& region, int dims, std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix3d covariance = Eigen::Map<const Eigen::Matrix3d>(region.covariance.data());
  if (dims == 2) {
    covariance.row(2).setZero();
    covariance.col(2).setZero();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Matrix3d root = solver.eigenvectors() *
                               solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
                               solver.eigenvectors().transpose() * region.radius;
  Eigen::Vector3d center(region.center.data());
  if (dims == 2) center.z() = 0;
  // In space circles of latitude, each wide enough for the space to the next.
  const int rings = dims == 3 ? kAround / 4 : 0;
  for (int ring = -rings; ring <= rings; ++ring) {
    const Eigen::Vector2d meridian = dims == 3 ? corner(ring, kAround) : Eigen::Vector2d(1, 0);
    for (int i = 0; i < kAround; ++i) {
      Eigen::Vector3d on_sphere;
      on_sphere << meridian.x() * corner(i, kAround), meridian.y();
      points.push_back(center + root * on_sphere);
    }
  }
}

/// The pixels of a body's surface about a position; nothing where that cannot be projected.
bool project_body(const Camera& camera, const Eigen::Vector3d& position, const Body& body,
                  std::vector<cv::Point2f>& pixels) {
  for (int i = 0; i < kAroundBody; ++i) {
    const Eigen::Vector2d side = body.radius * corner(i, kAroundBody);
    for (int level = 0; level <= kPieces; ++level) {
      const double z = -body.below + body.height() * level / kPieces;
      const Eigen::Vector3d point = position + Eigen::Vector3d(side.x(), side.y(), z);
      if (!(camera.depth(point) > kLeastDepth)) return false;
      const Eigen::Vector2d pixel = camera.project(point);
      if (!(pixel.cwiseAbs().maxCoeff() < kFarthestPx)) return false;
      pixels.emplace_back(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    }
  }
  return true;
}

/// Whether all of a body is behind the camera.
bool is_behind(const Camera& camera, const Eigen::Vector3d& position, const Body& body) {
  const double reach = std::hypot(body.radius, std::max(body.below, body.above));
  return camera.depth(position) + reach <= kLeastDepth;
}

/// The convex hull of what a body in the region covers, empty if all that is behind the camera;
/// nothing: some of it is.
std::optional<std::vector<cv::Point>> hull_of(const Camera& camera, const RegionOfInterest& region,
                                              const Body& body, int dims) {
  std::vector<Eigen::Vector3d> points;
  region.kind == RegionOfInterest::Kind::kPrism ? add_prism(region, dims, points)
                                                : add_ellipsoid(region, dims, points);
  if (std::all_of(points.begin(), points.end(),
                  [&](const auto& point) { return is_behind(camera, point, body); })) {
    return std::vector<cv::Point>();
  }
  std::vector<cv::Point2f> pixels, corners;
  for (const Eigen::Vector3d& point : points) {
    if (!project_body(camera, point, body, pixels)) return std::nullopt;
  }
  if (!pixels.empty()) cv::convexHull(pixels, corners);
  std::vector<cv::Point> hull;
  for (const cv::Point2f& p : corners) hull.emplace_back(cvRound(p.x), cvRound(p.y));
  return hull;
}

}  // namespace

Body body_of(const std::array<double, 3>& extent, int dims) {
  const double above = dims == 2 ? extent[2] : extent[2] / 2;
  return {std::hypot(extent[0], extent[1]) / 2, extent[2] - above, above};
}

RoiMask roi_mask(const Camera& camera, const std::vector<RegionOfInterest>& regions,
                 const Body& body, int dims) {
  const cv::Rect picture(0, 0, camera.width(), camera.height());
  const int width = 2 * kMarginPx + 1;
  const cv::Mat dilation = cv::getStructuringElement(cv::MORPH_RECT, {width, width});
  RoiMask result;
  std::vector<std::vector<cv::Point>> hulls;
  for (const RegionOfInterest& region : regions) {
    auto hull = hull_of(camera, region, body, dims);
    if (!hull) return {picture, cv::Mat1b(picture.size(), uchar{255})};
    if (hull->empty()) continue;
    cv::Rect box = cv::boundingRect(*hull);
    box -= cv::Point(kMarginPx, kMarginPx);
    box += cv::Size(2 * kMarginPx, 2 * kMarginPx);
    result.box |= box & picture;
    hulls.push_back(std::move(*hull));
  }
  result.mask = cv::Mat1b::zeros(result.box.size());
  if (result.box.empty()) return result;
  for (const auto& hull : hulls) {
    cv::fillConvexPoly(
        result.mask,
        [&] {
          std::vector<cv::Point> moved;
          for (const cv::Point& p : hull) moved.push_back(p - result.box.tl());
          return moved;
        }(),
        cv::Scalar(255));
  }
  cv::dilate(result.mask, result.mask, dilation);
  return result;
}

cv::Rect body_box(const Camera& camera, const Eigen::Vector3d& position, const Body& body) {
  std::vector<cv::Point2f> pixels;
  if (!project_body(camera, position, body, pixels)) return {};
  return cv::boundingRect(pixels);
}

}  // namespace anchord
