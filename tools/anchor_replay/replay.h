#pragma once

#include <functional>
#include <iosfwd>
#include <unordered_map>

#include "anchoring/world.h"
#include "api/world_line.h"
#include "tools/frame_source.h"

namespace anchord {

/// Seconds, of a clock that only goes forward.
using Stopwatch = std::function<double()>;

struct ReplayOptions {
  WorldLineOptions line;
  bool timing = true;                 ///< write `elapsed_us`
  std::optional<std::uint64_t> work;  ///< bound on what folding a frame may take; see Effort
  bool own_configuration = true;      ///< false: those that an exported log names are in force
};

/// What a replay did, for STATS.json.
struct ReplayStatistics {
  std::size_t frames = 0, detections = 0, events = 0;
  std::vector<double> update_ms;  ///< per applied frame
  std::size_t objects = 0;        ///< in the last best world
  std::uint64_t work = 0, cut_frames = 0;
  double dropped_probability = 0;  ///< mean per frame of Effort::dropped

  /// {"frames", "detections", "events", "update_ms": {"mean", "median", "p99", "max"},
  /// "peak_rss_mb", "objects", "work", "cut_frames", "dropped_probability"}
  Json json() const;
};

/// Folds all frames and events of a source and writes a line after each that was applied. One sent
/// again is passed over. Stops at a refused one with its position. Of an exported log its notes are
/// heeded; a state, where a span begins, needs a world of the configuration that it is of.
Result<ReplayStatistics> replay(World& world, FrameSource& source, std::ostream* output,
                                const ReplayOptions& options, const Stopwatch& stopwatch);

}  // namespace anchord
