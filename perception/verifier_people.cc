#include <algorithm>
#include <cmath>

#include "core/log_probability.h"
#include "perception/person_search.h"
#include "perception/verifier.h"

namespace anchord {

namespace {

constexpr int kMargin = 4;             ///< pixels about a person that the scene does not take up
constexpr double kShown = 0.5;         ///< less foreground: the empty scene is seen
constexpr Body kCore{0.2, 0, 1.74};    ///< of a person: pixels that she hides for certain
constexpr double kClothesDoubt = 0.3;  ///< of one look at the clothes

Gaussian position_of(const DetectedPerson& person) {
  Gaussian result;
  result.mean.head<2>() = person.position;
  result.covariance.topLeftCorner<2, 2>() = person.covariance;
  return result;
}

/// The settings as they are for a part of the picture, in which somebody is so tall. Those who
/// stand before her or beside her may reach into the part with little of themselves.
PersonSearch::Settings part_of(PersonSearch::Settings search, const cv::Rect& box, int height_px) {
  search.least_foot_row = std::max(0, search.least_foot_row - box.y);
  search.rows_below = height_px;
  search.columns_beside = height_px / 4;
  return search;
}

/// The tallest that somebody in the region comes out in the picture.
int height_px(const Camera& camera, const std::vector<Placement>& places) {
  int most = 1;
  for (const Placement& place : places) {
    most = std::max(most, body_box(camera, place.position, kCore).height);
  }
  return most;
}

/// Regions as people's feet have them, on the ground.
std::vector<RegionOfInterest> on_ground(std::vector<RegionOfInterest> regions) {
  for (RegionOfInterest& region : regions) region.center[2] = 0;
  return regions;
}

/// 255 where people are, or where nobody looked for them.
cv::Mat1b occupied_pixels(const std::vector<FoundPerson>& people, const cv::Mat1b& observable) {
  cv::Mat1b occupied = observable == 0;
  for (const FoundPerson& person : people) {
    cv::Rect box = person.silhouette.box();
    box -= cv::Point(kMargin, kMargin);
    box += cv::Size(2 * kMargin, 2 * kMargin);
    occupied(box & cv::Rect(cv::Point(), occupied.size())) = 255;
  }
  return occupied;
}

}  // namespace

double Verifier::fit(const DetectedPerson& person, const Task& task) const {
  double result = log_density(on_ground(task.regions), position_of(person), 2) +
                  std::log(person.score / (1 - person.score));
  if (person.colors.empty()) return result;
  for (const AttributeReport& attribute : task.appearance) {
    const auto* report = std::get_if<SymbolReport>(&attribute.value);
    if (attribute.name != "color" || !report) continue;
    double named = 0, likelihood = 0;
    const auto n = static_cast<double>(person.colors.size());
    for (std::size_t i = 0; i < person.colors.size(); ++i) {
      for (const auto& [name, p] : report->probabilities) {
        if (name != settings_.clothes.colors[i].name) continue;
        named += p;
        likelihood += p * ((1 - kClothesDoubt) * person.colors[i] * n + kClothesDoubt);
      }
    }
    result += std::log(likelihood + std::max(0.0, 1 - named));
  }
  return result;
}

Detection Verifier::report(const DetectedPerson& person) const {
  Detection detection = gauge_.report(person);
  if (dims_ == 2) return detection;
  // The middle of the body, upright on the ground.
  const double height = person.found.silhouette.height_m;
  const double variance = std::pow(settings_.search.height_deviation_m / 2, 2);
  auto& measured = std::get<CartesianMeasurement>(detection.measurement);
  const auto& c = measured.covariance;
  measured = {{measured.position[0], measured.position[1], rounded(height / 2, 1e3)},
              {c[0], c[1], 0, c[2], c[3], 0, 0, 0, variance}};
  return detection;
}

Sighting Verifier::look_for_person(const Part& part, const Task& task) {
  Sighting sighting;
  if (!scene_) {
    sighting.reason = settings_.camera.carried ? "people are looked for by cameras that stand still"
                                               : "the empty scene is not known";
    return sighting;
  }
  const cv::Mat1f foreground = scene_->foreground(part.picture.frame, part.box);
  const PersonSearch search(
      part.camera, part.observable,
      part_of(settings_.search, part.box, height_px(part.camera, part.places)));
  const std::vector<FoundPerson> people = search.find(foreground);
  scene_->update(part.picture.frame, part.box, occupied_pixels(people, part.observable));

  const PeoplePicture picture{part.camera, part.picture.frame, foreground, part.observable};
  std::vector<DetectedPerson> candidates;
  std::vector<double> fits;
  for (const FoundPerson& person : people) {
    DetectedPerson measured = gauge_.measure(person, people, picture);
    if (!may_lie_in(on_ground(task.regions), position_of(measured), 2)) continue;
    fits.push_back(fit(measured, task));
    candidates.push_back(std::move(measured));
  }
  if (candidates.empty()) {
    // People who overlap in the picture are easily taken for one: she is absent only from where the
    // empty scene is seen, not from where somebody is.
    const cv::Mat1b bare = part.observable & (foreground < kShown);
    return nothing_found(part, kCore, bare);
  }

  const auto best = std::max_element(fits.begin(), fits.end()) - fits.begin();
  const DetectedPerson& person = candidates[static_cast<std::size_t>(best)];
  const double confidence =
      std::exp(fits[static_cast<std::size_t>(best)] - log_sum(fits, [](double x) { return x; }));
  if (confidence < settings_.verification.least_confidence ||
      person.score < settings_.verification.least_score) {
    sighting.reason = confidence < settings_.verification.least_confidence
                          ? "more than one may be it"
                          : "hardly a person";
    return sighting;
  }
  sighting.sight = Sighting::Sight::kFound;
  sighting.visible = 1;
  sighting.detection = report(person);
  return sighting;
}

}  // namespace anchord
