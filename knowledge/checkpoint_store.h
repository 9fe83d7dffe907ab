#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "knowledge/sqlite.h"

namespace anchord {

/// A belief after some of the log, as bytes: what a start goes on from instead of folding it all.
struct StoredCheckpoint {
  std::int64_t sequence = 0;         ///< of the last frame or event that is in it
  std::uint32_t frame_checksum = 0;  ///< checksum() of that: the same log goes on from here
  std::uint64_t configuration = 0;   ///< Knowledge::fingerprint
  std::vector<std::uint8_t> bytes;
};

/// The newest checkpoints, in a database of their own beside the log (`anchord.db-checkpoints`):
/// they are written by another thread than frames are, and hold nothing that the log does not. A
/// file that is damaged, or of another format, is made anew. One thread at a time.
class CheckpointStore {
 public:
  /// How many are kept: should one be damaged, another is there.
  static constexpr std::int64_t kKept = 2;

  static Result<CheckpointStore> open(const std::string& directory);

  /// Keeps a checkpoint, durably, and forgets all but the newest ones.
  Status put(const StoredCheckpoint& checkpoint);

  /// The newest of that configuration whose sequence is below `before`, if its bytes are as they
  /// were written; nothing if there is none.
  Result<std::optional<StoredCheckpoint>> newest(std::uint64_t configuration, std::int64_t before);

 private:
  explicit CheckpointStore(sqlite::Database database) : database_(std::move(database)) {}
  sqlite::Database database_;
};

}  // namespace anchord
