#include "knowledge/log_schema.h"

#include <sqlite3.h>

#include <algorithm>
#include <utility>

namespace anchord {
namespace {

using sqlite::Database;
using sqlite::Transaction;

/// "anch", so that `file anchord.db` and another program can tell whose it is.
constexpr std::int64_t kApplicationId = 0x616e6368;

constexpr const char* kSchema = R"(
CREATE TABLE frames (
  sequence INTEGER PRIMARY KEY,
  utime INTEGER NOT NULL,
  robot TEXT NOT NULL,
  sensor TEXT NOT NULL,
  bytes BLOB NOT NULL,
  kind INTEGER NOT NULL DEFAULT 0,
  work INTEGER,
  checksum INTEGER
) STRICT;
CREATE INDEX events_by_time ON frames (utime) WHERE kind = 1;
CREATE TABLE tasks (id INTEGER PRIMARY KEY, ended INTEGER NOT NULL, bytes BLOB NOT NULL) STRICT;
)";

/// What version 5 added: frames are also found by their time; configurations; what old frames were
/// folded into; where objects were believed to be.
constexpr const char* kSinceVersion5 = R"(
CREATE UNIQUE INDEX frames_by_time ON frames (utime, robot, sensor) WHERE kind = 0;
CREATE TABLE configurations (
  first INTEGER PRIMARY KEY,
  text TEXT NOT NULL,
  checksum INTEGER NOT NULL
) STRICT;
CREATE TABLE base (
  sequence INTEGER PRIMARY KEY,
  first_kept INTEGER NOT NULL,
  utime INTEGER NOT NULL,
  frame_checksum INTEGER NOT NULL,
  configuration INTEGER NOT NULL,
  bytes BLOB NOT NULL,
  checksum INTEGER NOT NULL
) STRICT;
CREATE TABLE history (
  id INTEGER PRIMARY KEY,
  object TEXT NOT NULL,
  utime INTEGER NOT NULL,
  p REAL NOT NULL,
  place TEXT,
  x REAL NOT NULL,
  y REAL NOT NULL,
  z REAL NOT NULL,
  spread REAL NOT NULL
) STRICT;
CREATE UNIQUE INDEX history_by_object ON history (object, utime);
CREATE INDEX history_by_time ON history (utime);
CREATE TABLE thinned (grain INTEGER PRIMARY KEY, until INTEGER NOT NULL) STRICT;
)";

/// From version 1, which had frames only.
constexpr const char* kFromVersion1 = R"(
ALTER TABLE frames ADD COLUMN kind INTEGER NOT NULL DEFAULT 0;
CREATE INDEX events_by_time ON frames (utime) WHERE kind = 1;
CREATE TABLE tasks (id INTEGER PRIMARY KEY, ended INTEGER NOT NULL, bytes BLOB NOT NULL) STRICT;
)";

/// From version 2, which had no bounds on work.
constexpr const char* kFromVersion2 = "ALTER TABLE frames ADD COLUMN work INTEGER;";

/// From version 3, which had no checksums; its frames go without.
constexpr const char* kFromVersion3 = "ALTER TABLE frames ADD COLUMN checksum INTEGER;";

/// Before version 5 frames were found by sensor first.
constexpr const char* kFromVersion4 = "DROP INDEX IF EXISTS frames_by_sensor;";

Error io(std::string message) { return {ErrorCode::kIo, "", std::move(message)}; }

/// Refuses what is not this program's before anything in it is changed; true: it is new and empty.
Result<bool> recognise(Database& database, const std::string& path) {
  auto refuse = [&](const std::string& what) {
    return Error{ErrorCode::kConflict, "",
                 path + " " + what + "; move it and " + path +
                     "-mark away, or name another directory with --data"};
  };
  auto application = database.read_integer("PRAGMA application_id");
  if (!application) {
    if (database.extended_code() == SQLITE_NOTADB)
      return refuse(
          "is no SQLite database, or damaged: `anchorctl repair` saves what it has of this "
          "program");
    return application.error();
  }
  auto version = database.read_integer("PRAGMA user_version");
  if (!version) return version.error();
  auto objects = database.read_integer("SELECT count(*) FROM sqlite_schema");
  if (!objects) return objects.error();
  if (*application == 0 && *version == 0 && *objects == 0) return true;
  if (*application != kApplicationId) return refuse("is the database of another program");
  if (*version > kLogVersion)
    return Error{ErrorCode::kConflict, "",
                 path + " has version " + std::to_string(*version) +
                     ", and this program knows versions up to " + std::to_string(kLogVersion) +
                     "; install the newer program, or name another directory with --data"};
  return false;
}

Status create_schema(Database& database) {
  auto transaction = Transaction::begin(database);
  if (!transaction) return transaction.error();
  const std::string sql = std::string(kSchema) + kSinceVersion5 +
                          "PRAGMA application_id=" + std::to_string(kApplicationId) +
                          ";PRAGMA user_version=" + std::to_string(kLogVersion);
  if (auto made = database.execute(sql); !made) return made;
  return transaction->commit();
}

/// Brings an older version's database up to this one's, all of it or nothing.
Status upgrade(Database& database) {
  const auto version = database.read_integer("PRAGMA user_version");
  if (!version) return version.error();
  if (*version >= kLogVersion) return Done{};
  auto transaction = Transaction::begin(database);
  if (!transaction) return transaction.error();
  const std::string sql = (*version < 2 ? kFromVersion1 : std::string()) +
                          (*version < 3 ? kFromVersion2 : "") +
                          (*version < 4 ? kFromVersion3 : "") + kFromVersion4 + kSinceVersion5 +
                          ("PRAGMA user_version=" + std::to_string(kLogVersion));
  if (auto made = database.execute(sql); !made) return made;
  return transaction->commit();
}

/// WAL: a commit appends to one file and syncs it once; this connection moves the pages into the
/// database whenever the WAL has a thousand of them (SQLite's default). EXTRA, before that: a new
/// database has a rollback journal until it has a WAL. If that came back after a loss of power,
/// for the directory was not synced, SQLite would undo the database and drop the WAL with it.
Status configure(Database& database, std::int64_t max_bytes) {
  if (auto set = database.execute("PRAGMA synchronous=EXTRA"); !set) return set;
  auto mode = database.read_text("PRAGMA journal_mode=WAL");
  if (!mode) return mode.error();
  if (*mode != "wal") return io("the data directory's file system cannot hold a write-ahead log");
  if (max_bytes <= 0) return Done{};
  auto page = database.read_integer("PRAGMA page_size");
  if (!page) return page.error();
  const auto pages = std::max<std::int64_t>(1, max_bytes / *page);
  return database.execute("PRAGMA max_page_count=" + std::to_string(pages));
}

}  // namespace

Status prepare_log(Database& database, const std::string& path, std::int64_t max_bytes) {
  auto is_new = recognise(database, path);
  if (!is_new) return is_new.error();
  if (database.read_only())
    return io("cannot write " + path + "; give this user the right to write it");
  if (auto set = configure(database, max_bytes); !set) return set;
  return *is_new ? create_schema(database) : upgrade(database);
}

}  // namespace anchord
