#include "knowledge/frame_log.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "knowledge/sqlite.h"

namespace anchord {

namespace {

using sqlite::Database;
using sqlite::ResetAtEnd;
using sqlite::Statement;
using sqlite::Transaction;

/// "anch", so that `file anchord.db` and another program can tell whose it is.
constexpr std::int64_t kApplicationId = 0x616e6368;
/// Somebody who reads the database may hold it for a moment.
constexpr int kBusyMs = 1000;

constexpr const char* kSchema = R"(
CREATE TABLE frames (
  sequence INTEGER PRIMARY KEY,
  utime INTEGER NOT NULL,
  robot TEXT NOT NULL,
  sensor TEXT NOT NULL,
  bytes BLOB NOT NULL
) STRICT;
CREATE UNIQUE INDEX frames_by_sensor ON frames (robot, sensor, utime);
)";

Error io(std::string message) { return {ErrorCode::kIo, "", std::move(message)}; }

/// A file whose lock says that the directory is taken; it goes with the process, however it ends.
class DirectoryLock {
 public:
  static Result<DirectoryLock> take(const std::string& directory) {
    const std::string path = directory + "/anchord.lock";
    DirectoryLock lock(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
    if (lock.descriptor_ < 0)
      return io("cannot write in the data directory " + directory + ": " + std::strerror(errno) +
                "; give this user the right to write there, or name another directory with --data");
    if (::flock(lock.descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const int reason = errno;
      if (reason != EWOULDBLOCK) return io("cannot lock " + path + ": " + std::strerror(reason));
      return Error{ErrorCode::kUnavailable, "",
                   "the data directory " + directory + " is in use by another process" +
                       lock.holder() + "; stop that one, or name another directory with --data"};
    }
    const std::string pid = std::to_string(::getpid());
    if (::ftruncate(lock.descriptor_, 0) != 0 ||
        ::pwrite(lock.descriptor_, pid.data(), pid.size(), 0) != static_cast<ssize_t>(pid.size()))
      return io("cannot write " + path + ": " + std::strerror(errno));
    return lock;
  }
  DirectoryLock(DirectoryLock&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)) {}
  DirectoryLock& operator=(DirectoryLock&&) = delete;
  ~DirectoryLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

 private:
  explicit DirectoryLock(int descriptor) : descriptor_(descriptor) {}
  /// " (1234)" if the holder has written its number.
  std::string holder() const {
    char digits[16];
    const ssize_t size = ::pread(descriptor_, digits, sizeof digits, 0);
    return size > 0 ? " (" + std::string(digits, static_cast<std::size_t>(size)) + ")" : "";
  }
  int descriptor_;
};

Status make_directory(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!error && !std::filesystem::is_directory(directory, error) && !error)
    error = std::make_error_code(std::errc::not_a_directory);
  if (error)
    return io("cannot make the data directory " + directory + ": " + error.message() +
              "; name one that this user can write with --data");
  return Done{};
}

/// Refuses what is not this program's before anything in it is changed; true: it is new and empty.
Result<bool> recognise(Database& database, const std::string& path) {
  auto refuse = [&](const std::string& what) {
    return Error{ErrorCode::kConflict, "",
                 path + " " + what + "; move it away, or name another directory with --data"};
  };
  auto application = database.read_integer("PRAGMA application_id");
  if (!application) {
    if (database.extended_code() == SQLITE_NOTADB) return refuse("is no SQLite database");
    return application.error();
  }
  auto version = database.read_integer("PRAGMA user_version");
  if (!version) return version.error();
  auto objects = database.read_integer("SELECT count(*) FROM sqlite_schema");
  if (!objects) return objects.error();
  if (*application == 0 && *version == 0 && *objects == 0) return true;
  if (*application != kApplicationId) return refuse("is the database of another program");
  if (*version > FrameLog::kVersion)
    return Error{ErrorCode::kConflict, "",
                 path + " has version " + std::to_string(*version) +
                     ", and this program knows versions up to " +
                     std::to_string(FrameLog::kVersion) +
                     "; install the newer program, or name another directory with --data"};
  return false;
}

Status create_schema(Database& database) {
  auto transaction = Transaction::begin(database);
  if (!transaction) return transaction.error();
  const std::string sql = kSchema + ("PRAGMA application_id=" + std::to_string(kApplicationId)) +
                          ";PRAGMA user_version=" + std::to_string(FrameLog::kVersion);
  if (auto made = database.execute(sql); !made) return made;
  return transaction->commit();
}

/// WAL: a commit appends to one file and syncs it once (synchronous=FULL); this connection moves
/// the pages into the database whenever the WAL has a thousand of them (SQLite's default).
Status configure(Database& database, std::int64_t max_bytes) {
  auto mode = database.read_text("PRAGMA journal_mode=WAL");
  if (!mode) return mode.error();
  if (*mode != "wal") return io("the data directory's file system cannot hold a write-ahead log");
  if (auto set = database.execute("PRAGMA synchronous=FULL"); !set) return set;
  if (max_bytes <= 0) return Done{};
  auto page = database.read_integer("PRAGMA page_size");
  if (!page) return page.error();
  const auto pages = std::max<std::int64_t>(1, max_bytes / *page);
  return database.execute("PRAGMA max_page_count=" + std::to_string(pages));
}

}  // namespace

struct FrameLog::Store {
  DirectoryLock lock;
  Database database;
  Statement insert, find, latest, read;
  std::optional<Transaction> batch;
  bool failed;  ///< the open batch is lost
  std::int64_t last_sequence, committed_sequence;

  /// SQLite may have ended the transaction by itself; going on would lose the batch's beginning.
  bool batch_lost() const { return failed || (batch && !database.in_transaction()); }
};

FrameLog::FrameLog(std::unique_ptr<Store> store) : store_(std::move(store)) {}

FrameLog::~FrameLog() = default;

Result<std::unique_ptr<FrameLog>> FrameLog::open(const std::string& directory,
                                                 std::int64_t max_bytes) {
  if (auto made = make_directory(directory); !made) return made.error();
  auto lock = DirectoryLock::take(directory);
  if (!lock) return lock.error();
  const std::string path = directory + "/anchord.db";
  auto database = Database::open(path);
  if (!database) return database.error();
  sqlite3_busy_timeout(database->handle(), kBusyMs);
  auto is_new = recognise(*database, path);
  if (!is_new) return is_new.error();
  if (database->read_only())
    return io("cannot write " + path + "; give this user the right to write it");
  if (auto set = configure(*database, max_bytes); !set) return set.error();
  if (*is_new)
    if (auto made = create_schema(*database); !made) return made.error();

  auto insert = Statement::prepare(
      *database,
      "INSERT INTO frames (sequence, utime, robot, sensor, bytes) VALUES (?1, ?2, ?3, ?4, ?5)");
  if (!insert) return insert.error();
  auto find = Statement::prepare(
      *database, "SELECT bytes = ?4 FROM frames WHERE robot = ?1 AND sensor = ?2 AND utime = ?3");
  if (!find) return find.error();
  auto latest = Statement::prepare(
      *database, "SELECT max(utime) FROM frames WHERE robot = ?1 AND sensor = ?2");
  if (!latest) return latest.error();
  auto read = Statement::prepare(*database,
                                 "SELECT sequence, utime, robot, sensor, bytes FROM frames "
                                 "WHERE sequence >= ?1 ORDER BY sequence");
  if (!read) return read.error();
  auto last = database->read_integer("SELECT coalesce(max(sequence), 0) FROM frames");
  if (!last) return last.error();

  auto store = std::unique_ptr<Store>(new Store{*std::move(lock),
                                                *std::move(database),
                                                *std::move(insert),
                                                *std::move(find),
                                                *std::move(latest),
                                                *std::move(read),
                                                {},
                                                false,
                                                *last,
                                                *last});
  return std::unique_ptr<FrameLog>(new FrameLog(std::move(store)));
}

Status FrameLog::append(const LoggedFrame& frame) {
  if (store_->batch_lost()) return io("the batch has failed already and must be rolled back");
  if (frame.sequence <= store_->last_sequence)
    return Error{ErrorCode::kConflict, "sequence",
                 "is " + std::to_string(frame.sequence) + ", and must be above the log's last, " +
                     std::to_string(store_->last_sequence)};
  if (!store_->batch) {
    auto transaction = Transaction::begin(store_->database);
    if (!transaction) {
      store_->failed = true;
      return transaction.error();
    }
    store_->batch.emplace(*std::move(transaction));
  }
  Statement& insert = store_->insert;
  ResetAtEnd reset(insert);
  auto step = insert.bind(1, frame.sequence)
                  .bind(2, frame.utime)
                  .bind(3, std::string_view(frame.robot))
                  .bind(4, std::string_view(frame.sensor))
                  .bind(5, std::span<const std::uint8_t>(frame.bytes))
                  .step();
  if (step) {
    store_->last_sequence = frame.sequence;
    return Done{};
  }
  if (store_->database.extended_code() == SQLITE_CONSTRAINT_UNIQUE)
    return Error{ErrorCode::kConflict, "utime",
                 "the log has a frame of this sensor at " + std::to_string(frame.utime)};
  store_->failed = true;
  return io("cannot append to the frame log: " + step.error().message);
}

Status FrameLog::commit() {
  if (store_->batch_lost()) return io("the batch has failed already and must be rolled back");
  if (!store_->batch) return Done{};
  if (auto committed = store_->batch->commit(); !committed) {
    store_->failed = true;
    return io("cannot commit to the frame log: " + committed.error().message);
  }
  store_->batch.reset();
  store_->committed_sequence = store_->last_sequence;
  return Done{};
}

void FrameLog::rollback() {
  store_->batch.reset();
  store_->failed = false;
  store_->last_sequence = store_->committed_sequence;
}

std::int64_t FrameLog::last_sequence() const { return store_->last_sequence; }

Result<FrameLog::Presence> FrameLog::contains(std::string_view robot, std::string_view sensor,
                                              Utime utime, const std::vector<std::uint8_t>& bytes) {
  Statement& find = store_->find;
  ResetAtEnd reset(find);
  auto row = find.bind(1, robot)
                 .bind(2, sensor)
                 .bind(3, utime)
                 .bind(4, std::span<const std::uint8_t>(bytes))
                 .step();
  if (!row) return row.error();
  if (!*row) return Presence::kNo;
  return find.integer(0) == 1 ? Presence::kSame : Presence::kDifferent;
}

Result<std::optional<Utime>> FrameLog::latest(std::string_view robot, std::string_view sensor) {
  Statement& latest = store_->latest;
  ResetAtEnd reset(latest);
  auto row = latest.bind(1, robot).bind(2, sensor).step();
  if (!row) return row.error();
  std::optional<Utime> utime;
  if (!latest.is_null(0)) utime = latest.integer(0);
  return utime;
}

Status FrameLog::for_each(std::int64_t from_sequence,
                          const std::function<bool(const LoggedFrame&)>& callback) {
  Statement& read = store_->read;
  ResetAtEnd reset(read);
  read.bind(1, from_sequence);
  LoggedFrame frame;
  for (;;) {
    auto row = read.step();
    if (!row) return io("cannot read the frame log: " + row.error().message);
    if (!*row) return Done{};
    frame.sequence = read.integer(0);
    frame.utime = read.integer(1);
    frame.robot = read.text(2);
    frame.sensor = read.text(3);
    const auto bytes = read.bytes(4);
    frame.bytes.assign(bytes.begin(), bytes.end());
    if (!callback(frame)) return Done{};
  }
}

}  // namespace anchord
