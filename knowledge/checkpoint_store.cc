#include "knowledge/checkpoint_store.h"

#include <sqlite3.h>

#include <boost/crc.hpp>
#include <filesystem>
#include <utility>

namespace anchord {

namespace {

using sqlite::Database;
using sqlite::Statement;
using sqlite::Transaction;

constexpr std::int64_t kVersion = 1;

std::int64_t crc_of(const std::vector<std::uint8_t>& bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

/// A loss of power may take the last checkpoint along (synchronous=NORMAL), never an older one.
/// `code`: SQLite's own, where it fails.
Result<Database> prepared(const std::string& path, int& code) {
  auto database = Database::open(path);
  if (!database) return database;
  auto mode = database->read_text("PRAGMA journal_mode=WAL");
  code = database->extended_code() & 0xff;
  if (!mode) return mode.error();
  auto version = database->read_integer("PRAGMA user_version");
  code = database->extended_code() & 0xff;
  if (!version) return version.error();
  if (*version != 0 && *version != kVersion)
    return Error{ErrorCode::kConflict, "", path + " is of another version"};
  if (Status set = database->execute("PRAGMA synchronous=NORMAL"); !set) return set.error();
  if (*version == kVersion) return database;
  const Status made = database->execute(
      "CREATE TABLE checkpoints (sequence INTEGER PRIMARY KEY, "
      "frame_checksum INTEGER NOT NULL, configuration INTEGER NOT NULL, "
      "checksum INTEGER NOT NULL, bytes BLOB NOT NULL) STRICT;"
      "PRAGMA user_version=" +
      std::to_string(kVersion));
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

Status CheckpointStore::put(const StoredCheckpoint& checkpoint) {
  auto transaction = Transaction::begin(database_);
  if (!transaction) return transaction.error();
  auto insert = Statement::prepare(
      database_,
      "INSERT OR REPLACE INTO checkpoints (sequence, frame_checksum, configuration, "
      "checksum, bytes) VALUES (?1, ?2, ?3, ?4, ?5)");
  if (!insert) return insert.error();
  auto inserted = insert->bind(1, checkpoint.sequence)
                      .bind(2, static_cast<std::int64_t>(checkpoint.frame_checksum))
                      .bind(3, static_cast<std::int64_t>(checkpoint.configuration))
                      .bind(4, crc_of(checkpoint.bytes))
                      .bind(5, std::span<const std::uint8_t>(checkpoint.bytes))
                      .step();
  if (!inserted) return inserted.error();
  // Those beyond this one are of a log that was put aside.
  auto forget = Statement::prepare(
      database_,
      "DELETE FROM checkpoints WHERE sequence > ?1 OR sequence NOT IN "
      "(SELECT sequence FROM checkpoints WHERE sequence <= ?1 ORDER BY sequence DESC LIMIT ?2)");
  if (!forget) return forget.error();
  auto forgotten = forget->bind(1, checkpoint.sequence).bind(2, kKept).step();
  if (!forgotten) return forgotten.error();
  return transaction->commit();
}

Result<std::optional<StoredCheckpoint>> CheckpointStore::newest(std::uint64_t configuration,
                                                                std::int64_t before) {
  auto read =
      Statement::prepare(database_,
                         "SELECT sequence, frame_checksum, checksum, bytes FROM checkpoints "
                         "WHERE configuration = ?1 AND sequence < ?2 ORDER BY sequence DESC");
  if (!read) return read.error();
  read->bind(1, static_cast<std::int64_t>(configuration)).bind(2, before);
  for (;;) {
    auto row = read->step();
    if (!row) return row.error();
    if (!*row) return std::optional<StoredCheckpoint>();
    const auto bytes = read->bytes(3);
    StoredCheckpoint out{read->integer(0),
                         static_cast<std::uint32_t>(read->integer(1)),
                         configuration,
                         {bytes.begin(), bytes.end()}};
    if (crc_of(out.bytes) == read->integer(2)) return std::optional(std::move(out));
  }
}

}  // namespace anchord
