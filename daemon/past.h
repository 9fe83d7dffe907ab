#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "api/answers.h"
#include "core/result.h"
#include "daemon/configurations.h"
#include "daemon/refold.h"
#include "knowledge/checkpoint_store.h"
#include "knowledge/log_reader.h"

namespace anchord {

/// What was believed at earlier times: the log up to then, folded again. It reads log and
/// checkpoints beside their writers, begins at the nearest checkpoint, and remembers where the last
/// questions led, so that a time line may be gone along. One thread at a time.
class Past {
 public:
  /// `now`: an empty world of the configuration that runs.
  Past(std::string directory, World now) : directory_(std::move(directory)), now_(std::move(now)) {}

  /// The belief after all frames and events up to that time, in their order in time, late ones
  /// included, to the bit. Of events that came from a clock far ahead counts when they came. Before
  /// the first frame nothing is believed. `least`: what the log holds at least by now; it is waited
  /// for shortly where that is being written.
  /// kUnknown: that time is given up, see LogLimits.
  Result<Snapshot> at(Utime utime, std::int64_t least);

  /// The same as a world, and the first frame or event that is not in it.
  struct Then {
    World world;
    std::int64_t next;
  };
  Result<Then> world_at(Utime utime, std::int64_t least);

  /// What the log says besides; see LogReader.
  Result<LogReader*> log();

 private:
  /// A world that holds all up to a time, and where to go on for later ones.
  struct Known {
    Refold fold;
    Utime until = 0;        ///< everything up to that is in it
    std::int64_t next = 1;  ///< the first frame or event that is not in it
    std::int64_t seen = 0;  ///< up to here all is in it, or later than `until`
  };
  static constexpr std::size_t kKnown = 8;

  Result<const Known*> ask(Utime utime, std::int64_t least);
  Status await(std::int64_t least);
  Result<Known> reach(Utime utime);
  Result<Known> nearest(Utime utime);
  Status go_on(Known& known, Utime utime);

  std::string directory_;
  World now_;
  std::optional<LogReader> log_;
  std::optional<CheckpointStore> checkpoints_;
  std::unique_ptr<Configurations> configurations_;
  std::deque<Known> known_;  ///< newest question first
};

}  // namespace anchord
