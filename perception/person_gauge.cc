#include "perception/person_gauge.h"

#include <algorithm>
#include <cmath>

namespace anchord {

namespace {

double deviation(const DetectorSettings::Noise& noise, const FoundPerson& found) {
  return found.silhouette.height_px() * std::exp(noise.base + noise.covered * (1 - found.alone) +
                                                 noise.weak * std::max(0.0, 1 - found.gain));
}

}  // namespace

double rounded(double x, double steps) { return std::round(x * steps) / steps; }

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

PersonGauge::PersonGauge(const DetectorSettings& settings)
    : settings_(settings), clothes_(settings.clothes) {}

void PersonGauge::place(DetectedPerson& person, const Camera& camera) const {
  const Silhouette& body = person.found.silhouette;
  const Eigen::Vector2d foot = body.foot + settings_.foot_offset * body.height_px();
  std::optional<GroundPoint> ground = camera.to_ground(foot);
  if (!ground) ground = camera.to_ground(body.foot);  // found people stand on the ground
  const Eigen::Vector2d sigma(deviation(settings_.noise_u, person.found),
                              deviation(settings_.noise_v, person.found));
  const Eigen::Matrix2d root = ground->jacobian * sigma.asDiagonal();
  person.position = ground->position;
  person.covariance = root * root.transpose();
}

DetectedPerson PersonGauge::measure(const FoundPerson& found,
                                    const std::vector<FoundPerson>& people,
                                    const PeoplePicture& picture) const {
  DetectedPerson person;
  person.found = found;
  person.likeness = likeness_.of(picture.frame, found.silhouette);
  place(person, picture.camera);
  const DetectorSettings::Score& w = settings_.score;
  const double log_odds = w.bias + w.gain * found.gain + w.filled * found.filled +
                          w.observed * found.observed + w.alone * found.alone +
                          w.likeness * person.likeness;
  person.score = 1 / (1 + std::exp(-log_odds));
  person.colors =
      clothes_.shares(picture.frame, picture.foreground,
                      hidden_pixels(found, people, picture.observable), found.silhouette);
  return person;
}

Detection PersonGauge::report(const DetectedPerson& person) const {
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
  return detection;
}

}  // namespace anchord
