#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/result.h"
#include "knowledge/sqlite.h"
#include "knowledge/stored_checkpoint.h"

namespace anchord {

/// Checkpoints in a database of their own beside the log (`anchord.db-checkpoints`): they are
/// written by another thread than frames are, and hold nothing that the log does not. The newest
/// ones, for a start; and some of the past, for questions about it. A file that is damaged, or of a
/// newer version, is made anew. One thread at a time; several stores of one directory may be open.
class CheckpointStore {
 public:
  /// How many of the newest are there: should one be damaged, another is.
  static constexpr std::int64_t kNewest = 2;
  /// Bytes of those of the past; of more, every second one of the older half goes.
  static constexpr std::int64_t kPastBytes = std::int64_t{256} << 20;

  static Result<CheckpointStore> open(const std::string& directory);

  /// Adds a checkpoint, durably, and forgets those that are neither among the newest nor of the
  /// past; `past`: it is one that stays.
  Status put(const StoredCheckpoint& checkpoint, bool past = false);

  /// The calls below pass over what is not as it was written; nothing: there is none.

  /// The newest whose sequence is below `before`.
  Result<std::optional<StoredCheckpoint>> newest(std::int64_t before);
  /// The newest that holds nothing later than `utime`, and whose sequence is below `before`.
  Result<std::optional<StoredCheckpoint>> newest_until(Utime utime, std::int64_t before);
  /// The oldest whose sequence is at least `sequence`.
  Result<std::optional<StoredCheckpoint>> oldest_from(std::int64_t sequence);

  /// Forgets all with a sequence below this one's.
  Status forget_before(std::int64_t sequence);
  /// The sequence of the newest of the past; 0: there is none.
  Result<std::int64_t> newest_past();
  /// Of all that it holds.
  Result<std::int64_t> bytes();

 private:
  explicit CheckpointStore(sqlite::Database database) : database_(std::move(database)) {}
  Result<std::optional<StoredCheckpoint>> first_whole(const std::string& where, std::int64_t a,
                                                      std::int64_t b);
  Status thin_past();
  sqlite::Database database_;
};

}  // namespace anchord
