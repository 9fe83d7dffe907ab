#include "perception/verifier.h"

#include <algorithm>
#include <cmath>

#include "core/log_probability.h"
#include "geometry/conversion.h"
#include "perception/blob_search.h"
#include "perception/camera_pose.h"

namespace anchord {

namespace {

constexpr double kLeastFilled = 0.3;    ///< of the expected pixels of a blob
constexpr double kMostSizeError = 0.7;  ///< ln: half to twice as large
constexpr double kGap = 0.15;           ///< of a blob's size, between its parts
constexpr double kAtViewpoint = 1;      ///< m, of a carried camera from where its base shall stand
constexpr double kLeastDepth = 0.1;     ///< m: nearer is as good as behind the camera
/// Of people where nobody says: what a silhouette may cover, and some of what is around it.
constexpr std::array<double, 3> kPersonExtent{0.7, 0.7, 1.9};

bool is_person(const Task& task) { return task.object_class == "person"; }

/// Whether the robot is where the task wants it.
bool is_at_viewpoint(const Pose& pose, const Task& task) {
  if (!task.viewpoint) return true;
  const auto& there = task.viewpoint->position;
  return std::hypot(pose.position[0] - there[0], pose.position[1] - there[1]) <= kAtViewpoint;
}

CartesianMeasurement measurement_of(const Gaussian& position, int dims) {
  CartesianMeasurement measurement;
  for (int i = 0; i < dims; ++i) {
    measurement.position.push_back(rounded(position.mean[i], 1e4));
    for (int j = 0; j < dims; ++j) {
      measurement.covariance.push_back(
          rounded(position.covariance(std::min(i, j), std::max(i, j)), 1e9));
    }
  }
  return measurement;
}

}  // namespace

struct Verifier::Candidate {
  CartesianMeasurement measurement;  ///< in the frame of the picture's pose, as it is reported
  Gaussian in_map;                   ///< the same with the pose's error
  bool vague = false;                ///< the pose is too uncertain to say where it is
  double log_fit = 0;
};

Verifier::Verifier(const DetectorSettings& settings, const std::vector<cv::Mat>& scene, int dims)
    : settings_(settings), camera_(settings.camera), dims_(dims), gauge_(settings) {
  if (!scene.empty() && !settings.camera.carried) scene_.emplace(scene, settings.background);
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
  CV_Assert(picture.pose.has_value() == settings_.camera.carried);
  const std::optional<Pose>& pose = picture.pose;
  const Camera camera = pose ? camera_.at(*pose) : camera_;
  const std::vector<Placement> places = placements(task.regions, dims_);
  const Body body = body_of(extent_of(task), dims_);
  const RoiMask roi =
      roi_mask(camera, task.regions, pose ? apparent_body(body, places, *pose) : body, dims_);
  Sighting sighting;
  if (roi.box.empty()) {
    sighting.sight = pose ? Sighting::Sight::kElsewhere : Sighting::Sight::kHidden;
    sighting.reason = "the region is not in the picture";
    return sighting;
  }
  const cv::Rect& box = roi.box;
  Part part{camera.part(box.x, box.y, box.width, box.height),
            {picture.frame(box).clone(),
             picture.depth.empty() ? cv::Mat1f() : cv::Mat1f(picture.depth(box).clone()), pose},
            box,
            observable_pixels(settings_, box) & roi.mask,
            places,
            pose ? apparent_places(places, *pose, dims_) : places};
  sighting = is_person(task) ? look_for_person(part, task) : look_for_blob(part, task);
  if (pose && sighting.sight == Sighting::Sight::kHidden && !is_at_viewpoint(*pose, task)) {
    sighting.sight = Sighting::Sight::kElsewhere;
  }
  sighting.box = box;
  sighting.looked_at = static_cast<double>(box.area()) / size.area();
  if (sighting.detection) sighting.detection->object = task.object;
  return sighting;
}

Sighting Verifier::nothing_found(const Part& part, const Body& body, const cv::Mat1b& bare) const {
  const VerifierSettings& settings = settings_.verification;
  const auto share = [&](const Obstacles& obstacles) {
    return visible_share(part.camera, part.apparent, body, obstacles, settings.least_body);
  };
  Sighting sighting;
  sighting.visible = share({bare, part.picture.depth});
  if (part.picture.pose && share({bare, {}}) < settings.least_visible) {
    sighting.sight = Sighting::Sight::kElsewhere;
    sighting.reason = "too little of the region is in the picture";
    return sighting;
  }
  const bool enough = sighting.visible >= settings.least_visible;
  sighting.sight = enough ? Sighting::Sight::kAbsent : Sighting::Sight::kHidden;
  sighting.reason = enough ? "not there" : "too little of the region is in sight";
  return sighting;
}

Verifier::Candidate Verifier::candidate(const MeasuredBlob& blob, const Task& task,
                                        const std::optional<Pose>& pose) const {
  Candidate result{measurement_of(blob.position, dims_), blob.position};
  if (pose) {
    Eigen::Vector3d seen = blob.position.mean;
    if (dims_ == 2) seen.z() = extent_of(task)[2] / 2;
    result.measurement =
        measurement_of(in_sensor_frame(blob.position, seen.z(), *pose, dims_), dims_);
    const Result<Gaussian> in_map = to_map(result.measurement, pose, dims_);
    result.vague = !in_map || (dims_ == 2 && !ground_is_known(seen, *pose));
    if (in_map) result.in_map = *in_map;
  }
  const double z = blob.size_error / std::max(settings_.verification.size_deviation, 0.01);
  result.log_fit = log_density(task.regions, result.in_map, dims_) - 0.5 * z * z;
  return result;
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
  double in_front = 0, expected_depth = 0, expected_pixels = 0;
  for (const Placement& place : part.places) {
    const double depth = part.camera.depth(place.position);
    if (depth < kLeastDepth) continue;
    in_front += place.weight;
    expected_depth += place.weight * depth;
    expected_pixels += place.weight * body_box(part.camera, place.position, body).area();
  }
  if (in_front == 0) return nothing_found(part, body, part.observable);
  expected_depth /= in_front;
  expected_pixels /= in_front;
  const int gap = static_cast<int>(std::lround(kGap * std::sqrt(expected_pixels)));
  std::vector<Candidate> candidates;
  for (const Blob& blob :
       find_blobs(part.picture.frame, part.observable, part.picture.depth, settings_.clothes.colors,
                  colors, gap, static_cast<int>(kLeastFilled / 4 * expected_pixels))) {
    const auto measured = measure(blob, part.camera, extent, expected_depth, dims_, settings);
    if (!measured || measured->filled < kLeastFilled ||
        std::abs(measured->size_error) > kMostSizeError) {
      continue;
    }
    const Candidate found = candidate(*measured, task, part.picture.pose);
    if (!may_lie_in(task.regions, found.in_map, dims_)) continue;
    if (found.vague) {
      sighting.reason = "something may be it, but the camera's pose is too uncertain";
      return sighting;
    }
    candidates.push_back(found);
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
  sighting.detection = Detection{};
  sighting.detection->measurement = best->measurement;
  return sighting;
}

}  // namespace anchord
