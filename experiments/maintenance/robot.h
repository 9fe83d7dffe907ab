#pragma once

#include <algorithm>
#include <cmath>

#include "maintenance/viewpoint.h"

namespace anchord::experiment {

/// A robot that drives one way at a time.
class Robot {
 public:
  explicit Robot(const Eigen::Vector2d& start) { base_.position = start; }

  const BasePose& base() const { return base_; }
  RobotPose pose() const {
    RobotPose out;
    out.pose = base_.pose();
    return out;
  }

  void set_out(const Way& way, const BasePose& end) {
    way_ = way;
    end_ = end;
    along_ = 0;
  }

  /// Drives for some metres at most, and says how many.
  double drive(double most) {
    const double left = way_.length - along_;
    if (left <= most) {
      base_ = end_;
      along_ = way_.length;
      return std::max(left, 0.0);
    }
    along_ += most;
    double before = 0;
    for (std::size_t i = 1; i < way_.points.size(); ++i) {
      const Eigen::Vector2d d = way_.points[i] - way_.points[i - 1];
      const double length = d.norm();
      if (before + length >= along_) {
        base_.position = way_.points[i - 1] + (along_ - before) / length * d;
        base_.yaw = std::atan2(d.y(), d.x());
        break;
      }
      before += length;
    }
    return most;
  }

  bool arrived() const { return along_ >= way_.length; }

 private:
  BasePose base_, end_;
  Way way_{{}, 0};
  double along_ = 0;
};

}  // namespace anchord::experiment
