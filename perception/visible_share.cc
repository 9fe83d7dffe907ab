#include "perception/visible_share.h"

#include <algorithm>

namespace anchord {

namespace {

constexpr int kAcross = 6;          ///< points at which a body is tried, each way
constexpr double kTolerance = 0.1;  ///< m: nearer than the body by more is in front of it

bool hidden(const cv::Point& pixel, double nearest_depth, const Obstacles& obstacles) {
  const cv::Rect picture(cv::Point(), obstacles.observable.size());
  if (!picture.contains(pixel) || !obstacles.observable(pixel)) return true;
  // Written so that NaN hides, too.
  return !obstacles.depth.empty() && !(obstacles.depth(pixel) >= nearest_depth);
}

}  // namespace

double visible_share(const Camera& camera, const std::vector<Placement>& places, const Body& body,
                     const Obstacles& obstacles, double least_body) {
  double visible = 0;
  for (const Placement& place : places) {
    const cv::Rect box = body_box(camera, place.position, body);
    if (box.empty()) continue;
    const double nearest = std::max(camera.depth(place.position) - body.radius - kTolerance, 1e-3);
    int seen = 0;
    for (int i = 0; i < kAcross; ++i) {
      for (int j = 0; j < kAcross; ++j) {
        const cv::Point pixel(box.x + (2 * i + 1) * box.width / (2 * kAcross),
                              box.y + (2 * j + 1) * box.height / (2 * kAcross));
        if (!hidden(pixel, nearest, obstacles)) ++seen;
      }
    }
    if (seen >= least_body * kAcross * kAcross) visible += place.weight;
  }
  return visible;
}

}  // namespace anchord
