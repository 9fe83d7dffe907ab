#pragma once

#include <optional>
#include <vector>

#include "core/frame.h"
#include "experiments/maintenance/robot.h"
#include "experiments/soak/home.h"

namespace anchord::experiment {

/// The sensors of the home: a robot that goes round the rooms with a camera, and a camera above the
/// door. They miss, report what is not there, say the wrong class, and report things twice.
class Watch {
 public:
  Watch(const Knowledge& knowledge, const Site& site, std::uint64_t seed);

  /// Lets the robot go on its round for `dt` seconds.
  void step(double dt);
  BasePose base() const { return robot_.base(); }
  /// What the robot's camera sees now.
  Frame robot_camera(const Home& home, Utime utime);
  /// What the camera above the door sees now; it reports in the map frame.
  Frame hall_camera(const Home& home, Utime utime);

 private:
  struct Seen {
    int object_class, color;
    Eigen::Vector3d position;  ///< map frame
    double share;  ///< of the class's detection probability: held things are half hidden
  };
  static std::vector<Seen> visible(const Home& home);
  void look(const Sensor& sensor, const Home& home, const Eigen::Vector3d& eye_map,
            const Eigen::Matrix3d& map_from_sensor, Frame& frame);
  bool sees(const Sensor& sensor, const Eigen::Vector3d& point_map) const;
  void report(const Sensor& sensor, int object_class, int color, bool real,
              const Eigen::Vector3d& measured, Frame& frame);
  void clutter(const Sensor& sensor, const Eigen::Vector3d& eye_map,
               const Eigen::Matrix3d& map_from_sensor, Frame& frame);
  int draw(const std::vector<double>& probabilities);

  const Knowledge& knowledge_;
  const Site& site_;
  Dice dice_;
  Robot robot_;
  std::size_t stop_ = 0;
  int quarters_ = 0;  ///< that it still looks about at this stop
  double dwell_ = 0;  ///< s
};

}  // namespace anchord::experiment
