#pragma once

#include <memory>
#include <optional>
#include <string>

#include "knowledge/commit_mark.h"
#include "knowledge/data_directory.h"
#include "knowledge/frame_log.h"
#include "knowledge/sqlite.h"

namespace anchord {

using sqlite::Database;
using sqlite::Statement;
using sqlite::Transaction;

/// What a FrameLog keeps; for its own files.
struct FrameLog::Store {
  DirectoryLock lock;
  Database database;
  Statement insert, find, find_event, put_task, drop_tasks, read_tasks;
  std::optional<Transaction> batch;
  bool failed;  ///< the open batch is lost
  std::int64_t first_sequence, committed_first, last_sequence, committed_sequence;
  std::string directory;
  CommitMark mark;
  bool damaged = false;
  std::uint32_t last_checksum = 0;

  /// Takes the lock and the database when all goes well.
  static Result<std::unique_ptr<Store>> prepare(DirectoryLock& lock, Database& database,
                                                const std::string& directory,
                                                std::int64_t max_bytes);
  /// What could not be read, and that it is damage, if it is.
  Error failed_to(const std::string& what, const Error& error);
  /// The same of what had to be written.
  Error not_stored(const std::string& what, const Error& error) {
    return {ErrorCode::kStorage, "", failed_to(what, error).message};
  }
  Error found(const std::string& damage);
  /// SQLite may have ended the transaction by itself; going on would lose the batch's beginning.
  bool batch_lost() const { return failed || (batch && !database.in_transaction()); }
};

/// kStorage: nothing can be added to a batch that has failed.
Error lost_already();

}  // namespace anchord
