#include "daemon/rebuild.h"

#include <chrono>
#include <filesystem>

#include "daemon/checkpointer.h"
#include "daemon/history_recorder.h"
#include "daemon/refold.h"
#include "knowledge/configuration.h"
#include "knowledge/frame_log.h"

namespace anchord {
namespace {

constexpr std::int64_t kBatch = 1000;
constexpr double kInterval = 2;  // s of work between checkpoints

}  // namespace

Result<RebuildReport> rebuild(const std::string& directory,
                              const std::function<void(std::int64_t, std::int64_t)>& progress) {
  if (!std::filesystem::exists(directory + "/anchord.db"))
    return Error{ErrorCode::kUnknown, "", "there is no anchord.db in " + directory};
  auto log = FrameLog::open(directory);
  if (!log) return log.error();
  LogReader reader = (*log)->reader();
  const auto logged = reader.configurations();
  if (!logged) return logged.error();
  if (logged->empty())
    return Error{ErrorCode::kUnknown, "",
                 "the log says nothing of its configuration: it is of an older program; delete " +
                     directory + "/anchord.db-checkpoints, and a start folds it anew"};
  const auto last = parse_configuration(logged->back().text);
  if (!last.ok()) return invalid("", last.mistakes().front().text());
  const World now(last.knowledge());
  auto configurations = Configurations::of(reader, now);
  if (!configurations) return configurations.error();
  auto fold = Refold::begin(reader, *configurations);
  if (!fold) return fold.error();
  if (Status forgotten = (*log)->forget_history(fold->world().belief()->utime + 1); !forgotten)
    return forgotten.error();

  std::error_code gone;
  for (const char* part : {"", "-wal", "-shm"})
    std::filesystem::remove(directory + "/anchord.db-checkpoints" + part, gone);
  Checkpointer checkpointer(directory, now, kInterval);
  HistoryRecorder recorder(last.knowledge().log.history_grain);
  RebuildReport report{0, fold->from_sequence() + 1, 0};
  const std::int64_t all = (*log)->last_sequence();
  std::uint32_t last_checksum = 0;
  Status done = Done{};
  const Status read = reader.for_each(report.first, [&](const LoggedFrame& one) {
    const auto begin = std::chrono::steady_clock::now();
    if (done = fold->take(one); !done) return false;
    checkpointer.worked(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    const World& world = fold->world();
    for (const HistorySample& sample :
         recorder.look(world.settled(), *world.background(),
                       [](const auto&) { return std::optional<HistorySample>(); }))
      if (done = (*log)->put_sample(sample); !done) return false;
    last_checksum = checksum(one);
    if (++report.folded % kBatch != 0) return true;
    if (done = (*log)->commit(); !done) return false;
    checkpointer.take(world, one.sequence, last_checksum);
    progress(one.sequence, all);
    return true;
  });
  if (!read) return read.error();
  if (!done) return done.error();
  if (done = (*log)->commit(); !done) return done.error();
  checkpointer.finish();  // what is being written, so that the last one is taken
  checkpointer.demand();
  checkpointer.take(fold->world(), all, last_checksum);
  checkpointer.finish();
  report.checkpoints = checkpointer.bytes();
  return report;
}

}  // namespace anchord
