#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/time.h"

namespace anchord {

/// What was believed of an object at one time: a row of the log's table `history`.
struct HistorySample {
  std::string object;  ///< its name
  Utime utime = 0;
  double p = 0;                      ///< that it exists; 0: it was given up
  std::string place;                 ///< the deepest one with half of its density; empty: none
  std::array<double, 3> position{};  ///< mean of its density, map frame, m
  double spread = 0;  ///< root mean square distance from that along an axis of the plane, m
  bool operator==(const HistorySample&) const = default;
};

/// A stretch of one object's history.
struct HistorySpan {
  std::string object;
  Utime from = 0, to = kLatestUtime;
  std::int64_t most = 1000;  ///< samples; of more, those that stand evenly in time are given
};

/// How old history is thinned: of rows older than `age` at most one is kept in each `grain`, and
/// those at which the place changes.
struct HistoryGrain {
  double age, grain;  ///< s
};
inline constexpr std::array<HistoryGrain, 4> kHistoryGrains{
    {{3600, 10}, {86400, 60}, {7 * 86400, 600}, {30 * 86400, 3600}}};

}  // namespace anchord
