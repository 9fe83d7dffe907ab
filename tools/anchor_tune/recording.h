#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/result.h"

namespace anchord::tuning {

/// Where one object truly was at one time.
struct TruthRow {
  std::string id;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< map frame, m; z = 0 without a column z
  std::string class_name;                              ///< empty without a column `class`
  bool neutral = false;                                ///< neither to be found nor false if it is
};

/// By utime; a time at which there was nothing has an empty list, one without truth none.
using Truth = std::map<Utime, std::vector<TruthRow>>;

/// One sequence of frames, and what was true during it, if that is known.
struct Recording {
  std::vector<Frame> frames;  ///< in order of time
  std::optional<Truth> truth;
};

/// Frames from a file as anchor-replay reads them; events are passed over. `dims`: the world's.
/// Frames are sorted by utime, equal ones as they stand. Errors name file and line.
Result<std::vector<Frame>> read_frames(const std::string& path, int dims);

/// Truth from two CSV files with a header line, columns in any order: `truth` has frame, id, x, y,
/// and may have z, class and ignore (1: neutral), `index` has utime and frame. Every frame of the
/// index has truth, if only that there was nothing. Errors name file and line.
Result<Truth> read_truth(const std::string& truth, const std::string& index);

}  // namespace anchord::tuning
