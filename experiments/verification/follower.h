#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "anchoring/reading.h"
#include "anchoring/world.h"
#include "perception/look_series.h"
#include "perception/verifier.h"

namespace anchord {

/// What one frame of the video meant for the person who is followed.
struct Step {
  Utime utime = 0;
  double entropy_before = 0;  ///< of the predicted position, nat
  double entropy_after = 0;   ///< after the look, if there was one
  double gain = 0;            ///< expected of a look, nat
  bool looked = false;
  Sighting sighting;  ///< if looked
  double look_ms = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< afterwards, m
};

/// Follows one person by verification tasks alone (thesis section 3.8.1): at each frame the entropy
/// that a look is expected to take away is computed by a fake measurement (3.6), and only if that
/// is above the threshold the verifier looks, inside the region that holds 95 % of the predicted
/// density. What is found goes into the world with the person named, as the answer to a task does.
class Follower {
 public:
  /// `threshold` in nat.
  Follower(const Knowledge& knowledge, Verifier verifier, double threshold, int looks);

  /// Is told where a person stands (m) and looks there; whether one was found. From then on she is
  /// followed.
  bool start(const CameraPicture& picture, Utime utime, const Eigen::Vector2d& position);

  Step step(const CameraPicture& picture, Utime utime);

  /// Missed in so many looks in a row that she counts as missing.
  bool missing() const { return missing_; }

 private:
  std::optional<ObjectBelief> person(Utime utime) const;
  Task task(const ObjectBelief& person) const;
  /// Feeds a detection to the world and notes its covariance, the next fake measurement's.
  void tell(const Detection& detection, Utime utime);

  World world_;
  Verifier verifier_;
  double threshold_;
  LookSeries series_;
  int looks_;
  bool missing_ = false;
  Eigen::Matrix3d last_covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace anchord
