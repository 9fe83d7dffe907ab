#include "tools/anchor_replay/replay.h"

#include <sys/resource.h>

#include <algorithm>
#include <numeric>
#include <ostream>
#include <string_view>
#include <utility>

#include "anchoring/checkpoint.h"
#include "anchoring/reconfigure.h"
#include "api/logged.h"
#include "knowledge/configuration.h"
#include "lcmtypes/codec.h"
#include "lcmtypes/event_codec.h"

namespace anchord {
namespace {

/// Remembers what was applied, to tell what is sent again from what is out of order.
class Applied {
 public:
  /// True if this very frame or event has been applied.
  bool has(const Input& input) const {
    const auto [first, last] = digests_.equal_range(key(input));
    return std::any_of(first, last, [d = digest(input)](const auto& it) { return it.second == d; });
  }
  void add(const Input& input) { digests_.emplace(key(input), digest(input)); }

 private:
  static std::string key(const Input& input) {
    if (const auto* event = std::get_if<Event>(&input)) return std::to_string(event->utime);
    const Frame& frame = std::get<Frame>(input);
    return frame.robot + '\0' + frame.sensor + '\0' + std::to_string(frame.utime);
  }
  static std::size_t digest(const Input& input) {
    const auto bytes = std::visit([](const auto& one) { return canonical_bytes(one); }, input);
    return std::hash<std::string_view>()(
        {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  std::unordered_multimap<std::string, std::size_t> digests_;
};

/// What an exported log says of the world itself.
Status heed(World& world, const ReplayNote& note, bool own_configuration) {
  if (note.number) world.count_from(*note.number);
  if (!note.configuration.empty() && !own_configuration) {
    const auto configuration = parse_configuration(note.configuration);
    if (!configuration.ok())
      return invalid("configuration", configuration.mistakes().front().text());
    const Knowledge& knowledge = configuration.knowledge();
    if (knowledge.fingerprint != world.background()->knowledge.fingerprint) {
      auto changed = reconfigured(world, knowledge);
      if (!changed) return changed.error();
      world = *std::move(changed);
    }
  }
  if (!note.state) return Done{};
  if (world.belief()->frames > 0) return invalid("state", "must stand before all frames");
  auto state = read_checkpoint(note.state->checkpoint, world);
  if (!state) return state.error();
  if (state->recent.size() != note.state->recent.size())
    return invalid("state.recent", "must be what the checkpoint names");
  return world.resume(*std::move(state), note.state->recent);
}

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
          {"events", events},
          {"update_ms",
           {{"mean", update_ms.empty() ? 0 : sum / static_cast<double>(update_ms.size())},
            {"median", quantile(update_ms, 0.5)},
            {"p99", quantile(update_ms, 0.99)},
            {"max", quantile(update_ms, 1)}}},
          {"peak_rss_mb", static_cast<double>(usage.ru_maxrss) / 1024},
          {"objects", objects},
          {"work", work},
          {"cut_frames", cut_frames},
          {"dropped_probability", dropped_probability}};
}

Result<ReplayStatistics> replay(World& world, FrameSource& source, std::ostream* output,
                                const ReplayOptions& options, const Stopwatch& stopwatch) {
  ReplayStatistics statistics;
  Applied applied;
  std::optional<std::uint64_t> work;  // that a note says of what follows
  const auto refused = [&](const Error& error) {
    return Error{error.code, "", source.position() + ": " + error.text()};
  };
  while (true) {
    auto next = source.next_item();
    if (!next) return refused(next.error());
    if (!*next) break;
    if (const auto* note = std::get_if<ReplayNote>(&**next)) {
      if (Status heeded = heed(world, *note, options.own_configuration); !heeded)
        return refused(heeded.error());
      work = note->work;
      continue;
    }
    Accepted input;
    if (auto* frame = std::get_if<Frame>(&**next))
      input.what = std::move(*frame);
    else
      input.what = std::move(std::get<Event>(**next));
    if (applied.has(input.what)) continue;
    input.work = std::exchange(work, std::nullopt);
    if (options.work) input.work = options.work;
    const double before = stopwatch();
    if (Status done = apply(world, input); !done) return refused(done.error());
    const double elapsed = stopwatch() - before;
    applied.add(input.what);
    if (const auto* frame = std::get_if<Frame>(&input.what)) {
      ++statistics.frames;
      statistics.detections += frame->detections.size();
      statistics.update_ms.push_back(elapsed * 1e3);
      statistics.work += world.belief()->effort.work;
    } else {
      ++statistics.events;
    }
    if (!output) continue;
    WorldLineOptions line = options.line;
    if (options.timing) line.elapsed_us = elapsed * 1e6;
    *output << world_line(*world.belief(), *world.background(), line).dump() << '\n';
    if (!*output) return Error{ErrorCode::kIo, "", "the output cannot be written"};
  }
  statistics.cut_frames = world.belief()->cut_frames;
  if (statistics.frames > 0)
    statistics.dropped_probability =
        world.belief()->dropped / static_cast<double>(statistics.frames);
  for (const auto& object :
       read_objects(*world.belief(), world.belief()->utime, 0, *world.background()))
    statistics.objects += object.in_best ? 1 : 0;
  return statistics;
}

}  // namespace anchord
