#include "perception/person_detector.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace anchord {

namespace {

constexpr int kMargin = 4;         ///< pixels about a person that the background does not take up
constexpr double kViewStep = 200;  ///< pixels between the view's corners: lenses bend lines

cv::Mat1b observable_pixels(const DetectorSettings& settings) {
  cv::Mat1b result(settings.camera.height, settings.camera.width, uchar{255});
  for (const auto& polygon : settings.occluders) {
    std::vector<cv::Point> points;
    for (const auto& point : polygon) points.emplace_back(cvRound(point[0]), cvRound(point[1]));
    cv::fillPoly(result, std::vector<std::vector<cv::Point>>{points}, cv::Scalar(0));
  }
  return result;
}

/// Numbers are reported no finer than they mean anything, so that the last bits of a machine's
/// mathematics library do not show: positions to the millimetre.
double rounded(double x, double steps) { return std::round(x * steps) / steps; }

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

/// Pixels of people who stand nearer to the camera than one does, and what hides people always.
cv::Mat1b hidden_pixels(const FoundPerson& person, const std::vector<FoundPerson>& people,
                        const cv::Mat1b& observable) {
  cv::Mat1b hidden = observable == 0;
  for (const FoundPerson& other : people) {
    if (other.silhouette.foot.y() <= person.silhouette.foot.y()) continue;
    const cv::Rect box = other.silhouette.box() & cv::Rect(cv::Point(), hidden.size());
    for (int y = box.y; y < box.br().y; ++y) {
      for (int x = box.x; x < box.br().x; ++x) {
        if (other.silhouette.coverage(x, y) > 0.3) hidden(y, x) = 255;
      }
    }
  }
  return hidden;
}

double deviation(const DetectorSettings::Noise& noise, const FoundPerson& found) {
  return found.silhouette.height_px() * std::exp(noise.base + noise.covered * (1 - found.alone) +
                                                 noise.weak * std::max(0.0, 1 - found.gain));
}

}  // namespace

PersonDetector::PersonDetector(const DetectorSettings& settings,
                               const std::vector<cv::Mat>& background)
    : settings_(settings),
      camera_(settings.camera),
      background_(background, settings.background),
      observable_(observable_pixels(settings)),
      search_(camera_, observable_, settings.search),
      clothes_(settings.clothes),
      view_(ground_view(camera_, settings.view)) {}

void PersonDetector::place(DetectedPerson& person) const {
  const Silhouette& body = person.found.silhouette;
  const Eigen::Vector2d foot = body.foot + settings_.foot_offset * body.height_px();
  std::optional<GroundPoint> ground = camera_.to_ground(foot);
  if (!ground) ground = camera_.to_ground(body.foot);  // found people stand on the ground
  const Eigen::Vector2d sigma(deviation(settings_.noise_u, person.found),
                              deviation(settings_.noise_v, person.found));
  const Eigen::Matrix2d root = ground->jacobian * sigma.asDiagonal();
  person.position = ground->position;
  person.covariance = root * root.transpose();
}

std::vector<DetectedPerson> PersonDetector::detect(const cv::Mat& frame) {
  CV_Assert(frame.type() == CV_8UC3 && frame.size() == observable_.size());
  const cv::Mat1f foreground = background_.foreground(frame);
  const std::vector<FoundPerson> found = search_.find(foreground);
  cv::Mat1b occupied = cv::Mat1b::zeros(frame.size());
  std::vector<DetectedPerson> people;
  for (const FoundPerson& each : found) {
    cv::Rect box = each.silhouette.box();
    box -= cv::Point(kMargin, kMargin);
    box += cv::Size(2 * kMargin, 2 * kMargin);
    occupied(box & cv::Rect(cv::Point(), frame.size())) = 255;

    DetectedPerson person;
    person.found = each;
    person.likeness = likeness_.of(frame, each.silhouette);
    place(person);
    const DetectorSettings::Score& w = settings_.score;
    const double log_odds = w.bias + w.gain * each.gain + w.filled * each.filled +
                            w.observed * each.observed + w.alone * each.alone +
                            w.likeness * person.likeness;
    person.score = 1 / (1 + std::exp(-log_odds));
    person.colors = clothes_.shares(frame, foreground, hidden_pixels(each, found, observable_),
                                    each.silhouette);
    people.push_back(std::move(person));
  }
  background_.update(frame, occupied);
  return people;
}

Frame PersonDetector::report(const std::vector<DetectedPerson>& people, Utime utime) const {
  Frame frame;
  frame.utime = utime;
  frame.sensor = settings_.sensor;
  frame.view = view_;
  for (const DetectedPerson& person : people) {
    const Eigen::Matrix2d c = person.covariance.unaryExpr([](double x) { return rounded(x, 1e6); });
    Detection detection;
    detection.measurement =
        CartesianMeasurement{{rounded(person.position.x(), 1e3), rounded(person.position.y(), 1e3)},
                             {c(0, 0), c(0, 1), c(0, 1), c(1, 1)}};
    detection.score = rounded(person.score, 1e4);
    detection.attributes.push_back({"class", SymbolReport{{{"person", 1.0}}}});
    if (!person.colors.empty()) {
      detection.attributes.push_back({"color", clothes_.report(person.colors)});
    }
    frame.detections.push_back(std::move(detection));
  }
  return frame;
}

}  // namespace anchord
