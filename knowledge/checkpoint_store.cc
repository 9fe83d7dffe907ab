#include "knowledge/checkpoint_store.h"

#include <sqlite3.h>

#include <filesystem>
#include <utility>

namespace anchord {

namespace {

using sqlite::Database;
using sqlite::Statement;
using sqlite::Transaction;

constexpr std::int64_t kVersion = 2;
constexpr int kBusyMs = 1000;  // another store of the directory writes

/// A loss of power may take the last checkpoint along (synchronous=NORMAL), never an older one.
/// `code`: SQLite's own, where it fails.
Result<Database> prepared(const std::string& path, int& code) {
  auto database = Database::open(path);
  if (!database) return database;
  sqlite3_busy_timeout(database->handle(), kBusyMs);
  auto mode = database->read_text("PRAGMA journal_mode=WAL");
  code = database->extended_code() & 0xff;
  if (!mode) return mode.error();
  auto version = database->read_integer("PRAGMA user_version");
  code = database->extended_code() & 0xff;
  if (!version) return version.error();
  if (*version < 0 || *version > kVersion)
    return Error{ErrorCode::kConflict, "", path + " is of another version"};
  if (Status set = database->execute("PRAGMA synchronous=NORMAL"); !set) return set.error();
  if (*version == kVersion) return database;
  const Status made = database->execute(
      std::string("BEGIN IMMEDIATE;") +
      (*version == 0 ? "CREATE TABLE checkpoints (sequence INTEGER PRIMARY KEY, "
                       "frame_checksum INTEGER NOT NULL, configuration INTEGER NOT NULL, "
                       "checksum INTEGER NOT NULL, bytes BLOB NOT NULL) STRICT;"
                     : "") +
      "ALTER TABLE checkpoints ADD COLUMN utime INTEGER NOT NULL DEFAULT 0;"
      "ALTER TABLE checkpoints ADD COLUMN past INTEGER NOT NULL DEFAULT 0;"
      "CREATE INDEX checkpoints_by_time ON checkpoints (utime);"
      "PRAGMA user_version=" +
      std::to_string(kVersion) + ";COMMIT");
  if (!made) return made.error();
  return database;
}

}  // namespace

Result<CheckpointStore> CheckpointStore::open(const std::string& directory) {
  const std::string path = directory + "/anchord.db-checkpoints";
  int code = SQLITE_OK;
  auto database = prepared(path, code);
  if (!database && (code == SQLITE_CORRUPT || code == SQLITE_NOTADB ||
                    database.error().code == ErrorCode::kConflict)) {
    std::error_code ignored;
    for (const char* part : {"", "-wal", "-shm"}) std::filesystem::remove(path + part, ignored);
    database = prepared(path, code);
  }
  if (!database) return database.error();
  return CheckpointStore(*std::move(database));
}

Status CheckpointStore::put(const StoredCheckpoint& checkpoint, bool past) {
  auto transaction = Transaction::begin(database_);
  if (!transaction) return transaction.error();
  auto insert = Statement::prepare(
      database_,
      "INSERT OR REPLACE INTO checkpoints (sequence, frame_checksum, configuration, checksum, "
      "bytes, utime, past) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)");
  if (!insert) return insert.error();
  auto inserted = insert->bind(1, checkpoint.sequence)
                      .bind(2, static_cast<std::int64_t>(checkpoint.frame_checksum))
                      .bind(3, static_cast<std::int64_t>(checkpoint.configuration))
                      .bind(4, static_cast<std::int64_t>(checksum(checkpoint)))
                      .bind(5, std::span<const std::uint8_t>(checkpoint.bytes))
                      .bind(6, checkpoint.utime)
                      .bind(7, std::int64_t{past})
                      .step();
  if (!inserted) return inserted.error();
  // Those beyond this one are of a log that was put aside.
  auto forget = Statement::prepare(
      database_,
      "DELETE FROM checkpoints WHERE sequence > ?1 OR (past = 0 AND sequence NOT IN "
      "(SELECT sequence FROM checkpoints WHERE sequence <= ?1 ORDER BY sequence DESC LIMIT ?2))");
  if (!forget) return forget.error();
  auto forgotten = forget->bind(1, checkpoint.sequence).bind(2, kNewest).step();
  if (!forgotten) return forgotten.error();
  if (past)
    if (Status thinned = thin_past(); !thinned) return thinned;
  return transaction->commit();
}

Status CheckpointStore::thin_past() {
  const auto all = database_.read_integer(
      "SELECT coalesce(sum(length(bytes)), 0) FROM checkpoints WHERE past = 1");
  if (!all) return all.error();
  if (*all <= kPastBytes) return Done{};
  return database_.execute(
      "DELETE FROM checkpoints WHERE sequence IN (SELECT sequence FROM ("
      "SELECT sequence, row_number() OVER (ORDER BY sequence) AS place, "
      "count(*) OVER () AS number FROM checkpoints WHERE past = 1) "
      "WHERE place % 2 = 0 AND place <= number / 2)");
}

Result<std::optional<StoredCheckpoint>> CheckpointStore::first_whole(const std::string& where,
                                                                     std::int64_t a,
                                                                     std::int64_t b) {
  auto read = Statement::prepare(
      database_,
      "SELECT sequence, frame_checksum, configuration, checksum, bytes, utime FROM checkpoints " +
          where);
  if (!read) return read.error();
  read->bind(1, a).bind(2, b);
  for (;;) {
    auto row = read->step();
    if (!row) return row.error();
    if (!*row) return std::optional<StoredCheckpoint>();
    const auto bytes = read->bytes(4);
    StoredCheckpoint out{read->integer(0),
                         static_cast<std::uint32_t>(read->integer(1)),
                         static_cast<std::uint64_t>(read->integer(2)),
                         {bytes.begin(), bytes.end()},
                         read->integer(5)};
    if (checksum(out) == read->integer(3)) return std::optional(std::move(out));
  }
}

Result<std::optional<StoredCheckpoint>> CheckpointStore::newest(std::int64_t before) {
  return first_whole("WHERE sequence < ?1 AND ?2 = 0 ORDER BY sequence DESC", before, 0);
}

Result<std::optional<StoredCheckpoint>> CheckpointStore::newest_until(Utime utime,
                                                                      std::int64_t before) {
  return first_whole("WHERE utime BETWEEN 1 AND ?1 AND sequence < ?2 ORDER BY sequence DESC", utime,
                     before);
}

Result<std::optional<StoredCheckpoint>> CheckpointStore::oldest_from(std::int64_t sequence) {
  return first_whole("WHERE sequence >= ?1 AND ?2 = 0 ORDER BY sequence", sequence, 0);
}

Status CheckpointStore::forget_before(std::int64_t sequence) {
  auto forget = Statement::prepare(database_, "DELETE FROM checkpoints WHERE sequence < ?1");
  if (!forget) return forget.error();
  auto forgotten = forget->bind(1, sequence).step();
  if (!forgotten) return forgotten.error();
  return Done{};
}

Result<std::int64_t> CheckpointStore::newest_past() {
  return database_.read_integer(
      "SELECT coalesce(max(sequence), 0) FROM checkpoints WHERE past = 1");
}

Result<std::int64_t> CheckpointStore::bytes() {
  return database_.read_integer("SELECT coalesce(sum(length(bytes)), 0) FROM checkpoints");
}

}  // namespace anchord
