#pragma once

#include <cstdint>
#include <optional>

#include "anchoring/world.h"
#include "core/result.h"
#include "daemon/configurations.h"
#include "knowledge/log_reader.h"

namespace anchord {

/// Folds a log again, as it was folded when its frames came in: each under the configuration then
/// in force. A value: a copy is another way on from the same place. What it refers to must outlive
/// it.
class Refold {
 public:
  /// From the log's beginning: from its base, or from nothing.
  static Result<Refold> begin(LogReader& log, Configurations& configurations);
  /// From a checkpoint. kInvalid: it is of another log, another configuration or another program.
  static Result<Refold> from(const StoredCheckpoint& checkpoint, LogReader& log,
                             Configurations& configurations);

  /// Takes a frame or event, as it was taken.
  Status take(const LoggedFrame& logged);

  /// The last frame or event that is in it, as a checkpoint says; take() does not move it.
  std::int64_t from_sequence() const { return from_; }
  const World& world() const { return world_; }
  /// The world under the configuration that runs now. kConflict: that has taken away what is in
  /// use; the field names it.
  Result<World> under_the_present() const;

 private:
  Refold(World world, std::size_t index, std::int64_t from, Configurations& configurations)
      : world_(std::move(world)), index_(index), from_(from), configurations_(&configurations) {}

  World world_;
  std::size_t index_;  ///< of its configuration
  std::int64_t from_;
  Configurations* configurations_;
};

}  // namespace anchord
