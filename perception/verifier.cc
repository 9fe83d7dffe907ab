#include "perception/verifier.h"

#include <algorithm>
#include <cmath>

#include "core/log_probability.h"
#include "perception/blob_gauge.h"
#include "perception/blob_search.h"

namespace anchord {

namespace {

constexpr double kLeastFilled = 0.3;    ///< of the expected pixels of a blob
constexpr double kMostSizeError = 0.7;  ///< ln: half to twice as large
constexpr double kGap = 0.15;           ///< of a blob's size, between its parts
/// Of people where nobody says: what a silhouette may cover, and some of what is around it.
constexpr std::array<double, 3> kPersonExtent{0.7, 0.7, 1.9};

bool is_person(const Task& task) { return task.object_class == "person"; }

struct Candidate {
  MeasuredBlob blob;
  double log_fit;
};

Detection report(const Gaussian& position, int dims) {
  CartesianMeasurement measurement;
  for (int i = 0; i < dims; ++i) {
    measurement.position.push_back(rounded(position.mean[i], 1e4));
    for (int j = 0; j < dims; ++j) {
      measurement.covariance.push_back(
          rounded(position.covariance(std::min(i, j), std::max(i, j)), 1e9));
    }
  }
  Detection detection;
  detection.measurement = std::move(measurement);
  return detection;
}

}  // namespace

Verifier::Verifier(const DetectorSettings& settings, const std::vector<cv::Mat>& scene, int dims)
    : settings_(settings), camera_(settings.camera), dims_(dims), gauge_(settings) {
  if (!scene.empty()) scene_.emplace(scene, settings.background);
}

std::array<double, 3> Verifier::extent_of(const Task& task) const {
  if (*std::max_element(task.extent.begin(), task.extent.end()) > 0) return task.extent;
  const auto known = settings_.verification.appearances.find(task.object_class);
  if (known != settings_.verification.appearances.end()) return known->second.extent;
  return is_person(task) ? kPersonExtent : std::array<double, 3>{};
}

std::vector<std::string> Verifier::colors_of(const Task& task) const {
  for (const AttributeReport& attribute : task.appearance) {
    if (attribute.name == "color") return likely_colors(attribute);
  }
  const auto known = settings_.verification.appearances.find(task.object_class);
  if (known == settings_.verification.appearances.end()) return {};
  return known->second.colors;
}

Sighting Verifier::look(const CameraPicture& picture, const Task& task) {
  const cv::Size size(camera_.width(), camera_.height());
  CV_Assert(picture.frame.type() == CV_8UC3 && picture.frame.size() == size);
  CV_Assert(picture.depth.empty() || picture.depth.size() == size);
  const RoiMask roi = roi_mask(camera_, task.regions, body_of(extent_of(task), dims_), dims_);
  Sighting sighting;
  if (roi.box.empty()) {
    sighting.sight = Sighting::Sight::kHidden;
    sighting.reason = "the region is not in the picture";
    return sighting;
  }
  const cv::Rect& box = roi.box;
  Part part{camera_.part(box.x, box.y, box.width, box.height),
            {picture.frame(box).clone(),
             picture.depth.empty() ? cv::Mat1f() : cv::Mat1f(picture.depth(box).clone())},
            box,
            observable_pixels(settings_, box) & roi.mask,
            placements(task.regions, dims_)};
  sighting = is_person(task) ? look_for_person(part, task) : look_for_blob(part, task);
  sighting.box = box;
  sighting.looked_at = static_cast<double>(box.area()) / size.area();
  if (sighting.detection) sighting.detection->object = task.object;
  return sighting;
}

Sighting Verifier::nothing_found(const Part& part, const Body& body, const cv::Mat1b& bare) const {
  Sighting sighting;
  sighting.visible = visible_share(part.camera, part.places, body, {bare, part.picture.depth},
                                   settings_.verification.least_body);
  const bool enough = sighting.visible >= settings_.verification.least_visible;
  sighting.sight = enough ? Sighting::Sight::kAbsent : Sighting::Sight::kHidden;
  sighting.reason = enough ? "not there" : "too little of the region is in sight";
  return sighting;
}

Sighting Verifier::look_for_blob(const Part& part, const Task& task) const {
  const VerifierSettings& settings = settings_.verification;
  const auto extent = extent_of(task);
  const std::vector<std::string> colors = colors_of(task);
  Sighting sighting;
  if (colors.empty() || !(extent[2] > 0) || part.places.empty()) {
    sighting.reason = "its color or size is not known";
    return sighting;
  }
  Body body = body_of(extent, dims_);
  body.radius = (extent[0] + extent[1]) / 4;
  double expected_depth = 0, expected_pixels = 0;
  for (const Placement& place : part.places) {
    expected_depth += place.weight * part.camera.depth(place.position);
    expected_pixels += place.weight * body_box(part.camera, place.position, body).area();
  }
  const int gap = static_cast<int>(std::lround(kGap * std::sqrt(expected_pixels)));
  std::vector<Candidate> candidates;
  for (const Blob& blob :
       find_blobs(part.picture.frame, part.observable, part.picture.depth, settings_.clothes.colors,
                  colors, gap, static_cast<int>(kLeastFilled / 4 * expected_pixels))) {
    const auto measured = measure(blob, part.camera, extent, expected_depth, dims_, settings);
    if (!measured || measured->filled < kLeastFilled ||
        std::abs(measured->size_error) > kMostSizeError ||
        !may_lie_in(task.regions, measured->position, dims_)) {
      continue;
    }
    const double z = measured->size_error / std::max(settings.size_deviation, 0.01);
    candidates.push_back(
        {*measured, log_density(task.regions, measured->position, dims_) - 0.5 * z * z});
  }
  if (candidates.empty()) return nothing_found(part, body, part.observable);

  const auto best = std::max_element(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.log_fit < b.log_fit; });
  const double all = log_sum(candidates, [](const Candidate& c) { return c.log_fit; });
  if (std::exp(best->log_fit - all) < settings.least_confidence) {
    sighting.reason = "more than one may be it";
    return sighting;
  }
  sighting.sight = Sighting::Sight::kFound;
  sighting.visible = 1;
  sighting.detection = anchord::report(best->blob.position, dims_);
  return sighting;
}

}  // namespace anchord
