#pragma once

#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/lcm_bus.h"
#include "api/lcm_log.h"
#include "core/frame.h"
#include "core/result.h"
#include "perception/person_detector.h"

namespace anchord {

/// Where frames go: any of an LCM network, an LCM log, a file of JSON lines and a table of what
/// was measured of each detection.
class Outputs {
 public:
  struct Settings {
    std::optional<std::string> lcm_url;  ///< empty: LCM's default with ttl 0
    std::string log, jsonl, features;    ///< files; empty: none
  };
  /// Fails if a file cannot be written or the network not be reached.
  static Result<std::unique_ptr<Outputs>> open(const Settings& settings);

  /// `index` counts the video's frames from 1.
  Status write(int index, const Frame& frame, const std::vector<DetectedPerson>& people);

  /// Whether frames go to a network, where they should come at their own pace.
  bool live() const { return bus_ != nullptr; }

 private:
  Outputs() = default;
  Status create(std::ofstream& file, const std::string& path);
  void write_features(int index, const std::vector<DetectedPerson>& people);

  std::unique_ptr<LcmBus> bus_;
  std::ofstream log_file_, jsonl_, features_;
  std::optional<LcmLogWriter> log_;
};

}  // namespace anchord
