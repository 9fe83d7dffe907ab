#include "experiments/verification/follower.h"

#include <chrono>

#include "maintenance/entropy.h"
#include "maintenance/roi.h"
#include "models/kinematic.h"

namespace anchord {

namespace {

constexpr double kMass = 0.95;           ///< of the predicted density in the region (thesis 3.6)
constexpr double kStartDeviation = 0.4;  ///< of the place that start() is told, m
constexpr double kStartRadius = 2.4477;  ///< 95 % of a normal density in the plane

using Clock = std::chrono::steady_clock;

/// The expected gain (3.6): entropy before minus after a fake measurement at the predicted place
/// with the covariance of the last one. What it says of position alone it says of the whole state.
double expected_gain(const Gaussian& predicted, const Eigen::Matrix3d& noise) {
  Kinematic state = kinematic_at(predicted, 0, 2);
  update(state, {predicted.mean, noise}, 2);
  return gaussian_entropy(predicted.covariance, 2) - gaussian_entropy(state.pp, 2);
}

}  // namespace

Follower::Follower(const Knowledge& knowledge, Verifier verifier, double threshold, int looks)
    : world_(knowledge),
      verifier_(std::move(verifier)),
      threshold_(threshold),
      series_(looks),
      looks_(looks) {}

std::optional<ObjectBelief> Follower::person(Utime utime) const {
  auto objects = read_objects(*world_.belief(), utime, 0, *world_.background());
  std::optional<ObjectBelief> most;
  for (ObjectBelief& object : objects) {
    if (!most || object.p > most->p) most = std::move(object);
  }
  return most;
}

Task Follower::task(const ObjectBelief& person) const {
  Task task;
  task.state = Task::State::kIssued;
  task.object = person.anchor->id();
  task.object_class = "person";
  task.regions = regions_of(person, *world_.background(), kMass);
  task.appearance = appearance_of(person, *world_.background());
  return task;
}

void Follower::tell(const Detection& detection, Utime utime) {
  const auto& measured = std::get<CartesianMeasurement>(detection.measurement);
  last_covariance_.setZero();
  last_covariance_.topLeftCorner<2, 2>() =
      Eigen::Map<const Eigen::Matrix2d>(measured.covariance.data());
  Frame frame;
  frame.utime = utime;
  frame.sensor = "camera";
  frame.view = View{};  // none: of anybody else it says nothing
  frame.detections = {detection};
  const Status done = world_.apply(frame);
  if (!done) throw std::runtime_error("the engine refuses a detection: " + done.error().text());
}

bool Follower::start(const CameraPicture& picture, Utime utime, const Eigen::Vector2d& position) {
  const double variance = kStartDeviation * kStartDeviation;
  RegionOfInterest region;
  region.p = kMass;
  region.center = {position.x(), position.y(), 0};
  region.covariance = {variance, 0, 0, 0, variance, 0, 0, 0, 0};
  region.radius = kStartRadius;
  Task task;
  task.object_class = "person";
  task.regions = {region};
  const Sighting sighting = verifier_.look(picture, task);
  if (!sighting.detection) return false;
  tell(*sighting.detection, utime);
  return true;
}

Step Follower::step(const CameraPicture& picture, Utime utime) {
  const auto before = person(utime);
  if (!before) throw std::runtime_error("the engine has forgotten the person");
  Step step;
  step.utime = utime;
  const Gaussian predicted = before->moments(*world_.background());
  step.position = predicted.mean.head<2>();
  step.entropy_before = step.entropy_after = gaussian_entropy(predicted.covariance, 2);
  step.gain = expected_gain(predicted, last_covariance_);
  if (step.gain <= threshold_) return step;

  step.looked = true;
  const Clock::time_point begun = Clock::now();
  step.sighting = verifier_.look(picture, task(*before));
  step.look_ms = std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
  const auto outcome = series_.add(step.sighting);
  if (outcome) series_ = LookSeries(looks_);  // the task is done; the next is another
  missing_ = outcome == VerificationResult::Outcome::kMissing;
  if (step.sighting.detection) {
    tell(*step.sighting.detection, utime);
    if (const auto after = person(utime)) {
      const Gaussian updated = after->moments(*world_.background());
      step.position = updated.mean.head<2>();
      step.entropy_after = gaussian_entropy(updated.covariance, 2);
    }
  }
  return step;
}

}  // namespace anchord
