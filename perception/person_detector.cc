#include "perception/person_detector.h"

#include <algorithm>
#include <cmath>

namespace anchord {

namespace {

constexpr int kMargin = 4;         ///< pixels about a person that the scene does not take up
constexpr double kViewStep = 200;  ///< pixels between the view's corners: lenses bend lines

/// The polygon of pixels on the ground; its edges, straight in the picture, are nearly so there.
View ground_view(const Camera& camera, const std::vector<std::array<double, 2>>& pixels) {
  View view;
  view.type = View::Type::kPolygon;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Eigen::Vector2d from(pixels[i][0], pixels[i][1]);
    const auto& next = pixels[(i + 1) % pixels.size()];
    const Eigen::Vector2d to(next[0], next[1]);
    const int steps = std::max(1, static_cast<int>(std::lround((to - from).norm() / kViewStep)));
    for (int step = 0; step < steps; ++step) {
      const auto ground = camera.to_ground(from + (to - from) * step / steps);
      if (!ground) continue;
      view.points.push_back(
          {rounded(ground->position.x(), 1e3), rounded(ground->position.y(), 1e3)});
    }
  }
  return view;
}

}  // namespace

PersonDetector::PersonDetector(const DetectorSettings& settings,
                               const std::vector<cv::Mat>& background)
    : settings_(settings),
      camera_(settings.camera),
      scene_(background, settings.background),
      observable_(observable_pixels(settings)),
      search_(camera_, observable_, settings.search),
      gauge_(settings),
      view_(ground_view(camera_, settings.view)) {}

std::vector<DetectedPerson> PersonDetector::detect(const cv::Mat& frame) {
  CV_Assert(frame.type() == CV_8UC3 && frame.size() == observable_.size());
  const cv::Mat1f foreground = scene_.foreground(frame);
  const std::vector<FoundPerson> found = search_.find(foreground);
  const PeoplePicture picture{camera_, frame, foreground, observable_};
  cv::Mat1b occupied = cv::Mat1b::zeros(frame.size());
  std::vector<DetectedPerson> people;
  for (const FoundPerson& each : found) {
    cv::Rect box = each.silhouette.box();
    box -= cv::Point(kMargin, kMargin);
    box += cv::Size(2 * kMargin, 2 * kMargin);
    occupied(box & cv::Rect(cv::Point(), frame.size())) = 255;
    people.push_back(gauge_.measure(each, found, picture));
  }
  scene_.update(frame, occupied);
  return people;
}

Frame PersonDetector::report(const std::vector<DetectedPerson>& people, Utime utime) const {
  Frame frame;
  frame.utime = utime;
  frame.sensor = settings_.sensor;
  frame.view = view_;
  for (const DetectedPerson& person : people) frame.detections.push_back(gauge_.report(person));
  return frame;
}

}  // namespace anchord
