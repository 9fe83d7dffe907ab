#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/time.h"
#include "knowledge/history.h"
#include "knowledge/logged_frame.h"
#include "knowledge/sqlite.h"
#include "knowledge/stored_checkpoint.h"

namespace anchord {

/// A configuration that the log was written under.
struct LoggedConfiguration {
  std::int64_t first = 1;  ///< sequence of the first frame or event under it
  std::string text;        ///< Knowledge::text
  bool operator==(const LoggedConfiguration&) const = default;
};

/// What the beginning of the log was folded into when it was given up.
struct LogBase {
  StoredCheckpoint checkpoint;
  /// The first frame or event that is still in the log: at most checkpoint.sequence + 1, less where
  /// late frames may still have their place before it.
  std::int64_t first_kept = 1;
};

/// Reads a frame log: beside its writer, over a connection of its own, or as the writer itself.
/// What it reads is as it was committed; nothing is held while it does not read, so that the
/// writer's WAL can be emptied. One thread at a time.
///
/// Errors of all calls: kConflict: what stands there is damaged; kIo: it cannot be read.
class LogReader {
 public:
  /// Of the log in `directory`, for reading only. kUnknown: there is none.
  static Result<LogReader> open(const std::string& directory);
  /// Over a connection that outlives the reader; what is uncommitted there is seen, too.
  explicit LogReader(sqlite::Database& database) : database_(&database) {}

  /// 0 while the log is empty.
  Result<std::int64_t> last_sequence();
  /// The oldest frame or event that the log still holds; 1 for an empty one.
  Result<std::int64_t> first_sequence();

  /// Every frame and event with `sequence >= from`, in order of sequence, until the callback says
  /// false. kConflict also where one is missing.
  Status for_each(std::int64_t from, const std::function<bool(const LoggedFrame&)>& callback);
  /// The frame or event of that number, or nothing.
  Result<std::optional<LoggedFrame>> at(std::int64_t sequence);
  /// The frames of that time, of all sensors.
  Result<std::vector<LoggedFrame>> frames_at(Utime utime);

  /// In order; none in a log of before version 5.
  Result<std::vector<LoggedConfiguration>> configurations();
  /// Nothing while the log is whole.
  Result<std::optional<LogBase>> base();

  /// In order of time.
  Result<std::vector<HistorySample>> history(const HistorySpan& span);
  /// The newest sample of an object, or nothing.
  Result<std::optional<HistorySample>> last_sample(const std::string& object);

 private:
  Error failed(const Error& error) const;

  std::unique_ptr<sqlite::Database> own_;
  sqlite::Database* database_;
};

/// CRC-32 of a configuration in the log, and of a base, which stand beside them.
std::uint32_t checksum(const LoggedConfiguration& configuration);
std::uint32_t checksum(const LogBase& base);

}  // namespace anchord
