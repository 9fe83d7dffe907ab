#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace anchord {

/// What has happened since the start. Written and read by any thread.
struct Statistics {
  std::atomic<std::uint64_t> accepted{0};  ///< frames applied
  std::atomic<std::uint64_t> repeated{0};  ///< frames that were in the log already
  std::atomic<std::uint64_t> refused{0};   ///< frames, from anywhere
  std::atomic<std::uint64_t> unstored{0};  ///< of these, those that the disk did not take
  std::atomic<std::uint64_t> refused_lcm{
      0};                                 ///< messages over LCM: frames (of those) and questions
  std::atomic<std::uint64_t> ahead{0};    ///< of these, those too far ahead of the clock
  std::atomic<std::uint64_t> overrun{0};  ///< frames dropped because too many waited
  std::atomic<std::uint64_t> late{0};     ///< frames put in place behind newer ones
  std::atomic<std::uint64_t> lost{0};     ///< gaps in the numbering of LCM publishers
  std::atomic<std::uint64_t> received_lcm{0};   ///< frames that came over LCM
  std::atomic<std::uint64_t> published_lcm{0};  ///< messages sent
  std::atomic<std::uint64_t> commits{0}, commit_failures{0};
  std::atomic<std::uint64_t> queries{0};
};

/// How long updates take: all of them summed, and the latest few thousand for quantiles.
class UpdateTimes {
 public:
  void add(double seconds);

  struct Summary {
    std::uint64_t count = 0;
    double sum_s = 0, median_us = 0, p99_us = 0, max_us = 0;  ///< quantiles of the latest
  };
  Summary summary() const;

 private:
  mutable std::mutex mutex_;
  std::array<double, 4096> latest_{};
  std::uint64_t count_ = 0;
  double sum_ = 0;
};

/// Counts what is missing in the numbers that publishers give their frames. One thread at a time.
class SequenceGaps {
 public:
  /// How many frames of that sensor went missing before this one; 0 for an unnumbered one (seq 0)
  /// and when a publisher starts anew.
  std::uint64_t missing(const std::string& robot, const std::string& sensor, std::int64_t seq);

 private:
  static constexpr std::size_t kSensors = 4096;  ///< remembered; names are anybody's to invent
  std::map<std::pair<std::string, std::string>, std::int64_t> last_;
};

}  // namespace anchord
