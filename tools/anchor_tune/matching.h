#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "anchoring/background.h"
#include "anchoring/map_frame.h"
#include "tools/anchor_tune/recording.h"

namespace anchord::tuning {

enum class Verdict { kRight, kFalse, kNeutral };

/// A detection, held against the truth.
struct Judged {
  MapDetection placed;
  std::optional<double> score;
  Eigen::Vector3d in_sensor = Eigen::Vector3d::Zero();  ///< position, sensor frame
  bool seen_before = false;  ///< its place had been in view earlier in this recording
  bool needs_noise = false;  ///< a position without covariance: the sensor's noise holds
  Verdict verdict = Verdict::kNeutral;
  // Only of a right one:
  int object_class = -1;
  std::string object;
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();         ///< detection less truth, map frame
  Eigen::Vector3d sensor_residual = Eigen::Vector3d::Zero();  ///< the same along the sensor's axes
};

/// The class that it is reported as, most probably; -1 without a report of the class.
int label(const Judged& z);

/// The class that a detection is reported as, most probably; -1 without a report of the class.
int label(const MapDetection& z);

/// A true object, not neutral and in view, in one frame.
struct Sight {
  std::string object;
  int object_class = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  bool found = false;
  bool seen_before = false;  ///< its place had been in view earlier in this recording
  double range = 0;          ///< from the sensor, m; 0 in a frame without a pose
};

/// A frame that has truth, held against it.
struct JudgedFrame {
  int recording = 0, sensor = 0;  ///< sensor: index into Judgement::sensors
  Utime utime = 0;
  MapView view;
  std::vector<Judged> detections;
  std::vector<Sight> sights;
  double volume = 0;       ///< in view, m^dims, within the world's bounds
  double new_volume = 0;   ///< of it for the first time in this recording
  double old_seconds = 0;  ///< m^dims times s since the frame before, of what is not new
};

struct Judgement {
  std::vector<std::string> sensors;
  std::vector<JudgedFrame> frames;  ///< by recording, in order of time
};

/// Places every frame that has truth in the map, as the engine does, and gives detections to true
/// objects one to one: least sum of distances, at most `radius` (m) apart; a detection whose most
/// probable class is another counts half a radius more. Neutral are detections of neutral rows (and
/// of objects out of view or of a class that the configuration has not), and those left over within
/// `radius` of one. Where an object's rows have a gap, it is taken to have been on the straight
/// line between them, there and not to be found, if that is in view. Refuses what place_in_map()
/// refuses.
Result<Judgement> judge(const std::vector<Recording>& recordings, double radius,
                        const Background& background);

}  // namespace anchord::tuning
