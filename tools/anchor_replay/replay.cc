#include "tools/anchor_replay/replay.h"

#include <sys/resource.h>

#include <algorithm>
#include <numeric>
#include <ostream>
#include <string_view>

#include "lcmtypes/codec.h"

namespace anchord {
namespace {

/// Remembers what was applied, to tell a frame sent again from one out of order.
class Applied {
 public:
  /// True if this very frame has been applied.
  bool has(const Frame& frame) const {
    const auto it = digests_.find(key(frame));
    return it != digests_.end() && it->second == digest(frame);
  }
  void add(const Frame& frame) { digests_[key(frame)] = digest(frame); }

 private:
  static std::string key(const Frame& frame) {
    return frame.robot + '\0' + frame.sensor + '\0' + std::to_string(frame.utime);
  }
  static std::size_t digest(const Frame& frame) {
    const auto bytes = canonical_bytes(frame);
    return std::hash<std::string_view>()(
        {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  std::unordered_map<std::string, std::size_t> digests_;
};

double quantile(std::vector<double> sorted, double q) {
  if (sorted.empty()) return 0;
  std::sort(sorted.begin(), sorted.end());
  const double at = q * static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(at + 0.5)];
}

}  // namespace

Json ReplayStatistics::json() const {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double sum = std::accumulate(update_ms.begin(), update_ms.end(), 0.0);
  return {{"frames", frames},
          {"detections", detections},
          {"update_ms",
           {{"mean", update_ms.empty() ? 0 : sum / static_cast<double>(update_ms.size())},
            {"median", quantile(update_ms, 0.5)},
            {"p99", quantile(update_ms, 0.99)},
            {"max", quantile(update_ms, 1)}}},
          {"peak_rss_mb", static_cast<double>(usage.ru_maxrss) / 1024},
          {"objects", objects}};
}

Result<ReplayStatistics> replay(World& world, FrameSource& source, std::ostream* output,
                                const ReplayOptions& options, const Stopwatch& stopwatch) {
  ReplayStatistics statistics;
  Applied applied;
  const auto refused = [&](const Error& error) {
    return Error{error.code, "", source.position() + ": " + error.text()};
  };
  while (true) {
    auto frame = source.next();
    if (!frame) return refused(frame.error());
    if (!*frame) break;
    if (applied.has(**frame)) continue;
    const double before = stopwatch();
    if (Status done = world.apply(**frame); !done) return refused(done.error());
    const double elapsed = stopwatch() - before;
    applied.add(**frame);
    ++statistics.frames;
    statistics.detections += (**frame).detections.size();
    statistics.update_ms.push_back(elapsed * 1e3);
    if (!output) continue;
    WorldLineOptions line = options.line;
    if (options.timing) line.elapsed_us = elapsed * 1e6;
    *output << world_line(*world.belief(), *world.background(), line).dump() << '\n';
    if (!*output) return Error{ErrorCode::kIo, "", "the output cannot be written"};
  }
  for (const auto& object :
       read_objects(*world.belief(), world.belief()->utime, 0, *world.background()))
    statistics.objects += object.in_best ? 1 : 0;
  return statistics;
}

}  // namespace anchord
