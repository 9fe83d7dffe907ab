#include "knowledge/frame_log.h"

#include <sqlite3.h>

#include <utility>

#include "knowledge/frame_log_store.h"
#include "knowledge/log_schema.h"

namespace anchord {

namespace {

using sqlite::ResetAtEnd;

/// Somebody who reads the database may hold it for a moment.
constexpr int kBusyMs = 1000;

/// What SQLite says of a file whose content cannot be: also that its tables are others.
bool tells_of_damage(int extended_code) {
  const int code = extended_code & 0xff;
  return code == SQLITE_CORRUPT || code == SQLITE_NOTADB || code == SQLITE_ERROR;
}

Error damage(const std::string& directory, const std::string& what) {
  return {ErrorCode::kConflict, "",
          directory + "/anchord.db is damaged: " + what + "; `anchorctl repair " + directory +
              "` saves what can be saved"};
}

/// What was being done, before what SQLite says of it.
Error while_doing(const std::string& what, const Error& error) {
  return {error.code, error.field, "cannot " + what + ": " + error.message};
}

}  // namespace

Error lost_already() {
  return {ErrorCode::kStorage, "", "the batch has failed already and must be rolled back"};
}

FrameLog::FrameLog(std::unique_ptr<Store> store) : store_(std::move(store)) {}

FrameLog::~FrameLog() {
  store_->batch.reset();
  // Closing moves what the WAL holds into the database and drops it: damage would be made final.
  sqlite3_db_config(store_->database.handle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE,
                    store_->damaged ? 1 : 0, nullptr);
}

Result<std::unique_ptr<FrameLog>> FrameLog::open(const std::string& directory,
                                                 std::int64_t max_bytes) {
  if (auto made = make_directory(directory); !made) return made.error();
  auto lock = DirectoryLock::take(directory);
  if (!lock) return lock.error();
  const std::string path = directory + "/anchord.db";
  auto database = Database::open(path);
  if (!database) return database.error();
  sqlite3_busy_timeout(database->handle(), kBusyMs);
  sqlite3_db_config(database->handle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  auto store = Store::prepare(*lock, *database, directory, max_bytes);
  if (store) return std::unique_ptr<FrameLog>(new FrameLog(*std::move(store)));
  if (store.error().code == ErrorCode::kConflict) return store.error();
  if (tells_of_damage(database->extended_code())) return damage(directory, store.error().message);
  return while_doing("open the frame log " + path, store.error());
}

Result<std::unique_ptr<FrameLog::Store>> FrameLog::Store::prepare(DirectoryLock& lock,
                                                                  Database& database,
                                                                  const std::string& directory,
                                                                  std::int64_t max_bytes) {
  const std::string path = directory + "/anchord.db";
  CommitMark mark(path + "-mark");
  const std::int64_t committed = mark.read();
  const auto end = database.read_integer("SELECT coalesce(max(sequence), 0) FROM frames");
  const bool no_table = !end && database.extended_code() == SQLITE_ERROR;
  if ((end && *end < committed) || (no_table && committed > 0))
    return damage(directory, "it ends at frame " + std::to_string(end ? *end : 0) + ", and " +
                                 std::to_string(committed) + " frames were acknowledged");
  if (auto ready = prepare_log(database, path, max_bytes); !ready) return ready.error();
  // Never set by this program; where a flipped bit sets it, SQLite would write over pages.
  const auto auto_vacuum = database.read_integer("PRAGMA auto_vacuum");
  if (!auto_vacuum) return auto_vacuum.error();
  if (*auto_vacuum != 0) return damage(directory, "its header is another than it was made with");
  auto insert =
      Statement::prepare(database,
                         "INSERT INTO frames (sequence, utime, robot, sensor, bytes, kind, work, "
                         "checksum) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)");
  if (!insert) return insert.error();
  auto find = Statement::prepare(database,
                                 "SELECT bytes = ?4 FROM frames "
                                 "WHERE robot = ?1 AND sensor = ?2 AND utime = ?3 AND kind = 0");
  if (!find) return find.error();
  auto find_event = Statement::prepare(
      database, "SELECT 1 FROM frames WHERE utime = ?1 AND kind = 1 AND bytes = ?2");
  if (!find_event) return find_event.error();
  auto put_task = Statement::prepare(
      database, "INSERT OR REPLACE INTO tasks (id, ended, bytes) VALUES (?1, ?2, ?3)");
  if (!put_task) return put_task.error();
  auto drop_tasks = Statement::prepare(
      database, "DELETE FROM tasks WHERE ended = 1 AND id <= (SELECT max(id) FROM tasks) - ?1");
  if (!drop_tasks) return drop_tasks.error();
  auto read_tasks = Statement::prepare(database, "SELECT id, bytes FROM tasks ORDER BY id");
  if (!read_tasks) return read_tasks.error();
  auto first = database.read_integer(
      "SELECT coalesce((SELECT min(sequence) FROM frames), (SELECT first_kept FROM base), 1)");
  if (!first) return first.error();
  auto last = database.read_integer(
      "SELECT coalesce((SELECT max(sequence) FROM frames), (SELECT first_kept - 1 FROM base), 0)");
  if (!last) return last.error();

  return std::unique_ptr<Store>(new Store{std::move(lock),
                                          std::move(database),
                                          *std::move(insert),
                                          *std::move(find),
                                          *std::move(find_event),
                                          *std::move(put_task),
                                          *std::move(drop_tasks),
                                          *std::move(read_tasks),
                                          {},
                                          false,
                                          *first,
                                          *first,
                                          *last,
                                          *last,
                                          directory,
                                          std::move(mark)});
}

Error FrameLog::Store::found(const std::string& what) {
  damaged = true;
  return {ErrorCode::kIo, "", damage(directory, what).message};
}

Error FrameLog::Store::failed_to(const std::string& what, const Error& error) {
  return tells_of_damage(database.extended_code()) ? found(error.message)
                                                   : while_doing(what, error);
}

Status FrameLog::begin_batch() {
  if (store_->batch_lost()) return lost_already();
  if (store_->batch) return Done{};
  auto transaction = Transaction::begin(store_->database);
  if (!transaction) {
    store_->failed = true;
    return store_->not_stored("write to the frame log", transaction.error());
  }
  store_->batch.emplace(*std::move(transaction));
  return Done{};
}

Status FrameLog::append(const LoggedFrame& frame) {
  if (store_->batch_lost()) return lost_already();
  if (frame.sequence != store_->last_sequence + 1)
    return Error{ErrorCode::kConflict, "sequence",
                 "is " + std::to_string(frame.sequence) + ", and must follow the log's last, " +
                     std::to_string(store_->last_sequence)};
  if (Status begun = begin_batch(); !begun) return begun;
  Statement& insert = store_->insert;
  ResetAtEnd reset(insert);
  insert.bind(1, frame.sequence)
      .bind(2, frame.utime)
      .bind(3, std::string_view(frame.robot))
      .bind(4, std::string_view(frame.sensor))
      .bind(5, std::span<const std::uint8_t>(frame.bytes))
      .bind(6, static_cast<std::int64_t>(frame.kind));
  if (frame.work) insert.bind(7, *frame.work);
  const std::uint32_t sum = checksum(frame);
  insert.bind(8, static_cast<std::int64_t>(sum));
  auto step = insert.step();
  if (step) {
    store_->last_sequence = frame.sequence;
    store_->last_checksum = sum;
    return Done{};
  }
  if (store_->database.extended_code() == SQLITE_CONSTRAINT_UNIQUE)
    return Error{ErrorCode::kConflict, "utime",
                 "the log has a frame of this sensor at " + std::to_string(frame.utime)};
  store_->failed = true;
  return store_->not_stored("append to the frame log", step.error());
}

Status FrameLog::commit() {
  if (store_->batch_lost()) return lost_already();
  if (!store_->batch) return Done{};
  if (auto committed = store_->batch->commit(); !committed) {
    store_->failed = true;
    return store_->not_stored("commit to the frame log", committed.error());
  }
  store_->batch.reset();
  store_->committed_sequence = store_->last_sequence;
  store_->committed_first = store_->first_sequence;
  store_->mark.write(store_->last_sequence);
  return Done{};
}

void FrameLog::rollback() {
  store_->batch.reset();
  store_->failed = false;
  store_->last_sequence = store_->committed_sequence;
  // What drop() dropped is there again: that is found by dropping it again.
  store_->first_sequence = store_->committed_first;
}

std::int64_t FrameLog::last_sequence() const { return store_->last_sequence; }

std::uint32_t FrameLog::last_checksum() const { return store_->last_checksum; }

Result<FrameLog::Presence> FrameLog::contains(std::string_view robot, std::string_view sensor,
                                              Utime utime, const std::vector<std::uint8_t>& bytes) {
  Statement& find = store_->find;
  ResetAtEnd reset(find);
  auto row = find.bind(1, robot)
                 .bind(2, sensor)
                 .bind(3, utime)
                 .bind(4, std::span<const std::uint8_t>(bytes))
                 .step();
  if (!row) return store_->failed_to("read the frame log", row.error());
  if (!*row) return Presence::kNo;
  return find.integer(0) == 1 ? Presence::kSame : Presence::kDifferent;
}

Result<bool> FrameLog::contains_event(Utime utime, const std::vector<std::uint8_t>& bytes) {
  Statement& find = store_->find_event;
  ResetAtEnd reset(find);
  auto row = find.bind(1, utime).bind(2, std::span<const std::uint8_t>(bytes)).step();
  if (!row) return store_->failed_to("read the frame log", row.error());
  return row;
}

Status FrameLog::put_task(std::int64_t id, bool ended, const std::vector<std::uint8_t>& bytes) {
  if (Status begun = begin_batch(); !begun) return begun;
  Statement& put = store_->put_task;
  ResetAtEnd reset(put);
  auto step = put.bind(1, id)
                  .bind(2, static_cast<std::int64_t>(ended))
                  .bind(3, std::span<const std::uint8_t>(bytes))
                  .step();
  if (step) return Done{};
  store_->failed = true;
  return store_->not_stored("keep the task", step.error());
}

Status FrameLog::keep_tasks(std::int64_t count) {
  if (Status begun = begin_batch(); !begun) return begun;
  Statement& drop = store_->drop_tasks;
  ResetAtEnd reset(drop);
  auto step = drop.bind(1, count).step();
  if (step) return Done{};
  store_->failed = true;
  return store_->not_stored("drop old tasks", step.error());
}

Status FrameLog::for_each_task(
    const std::function<bool(std::int64_t, std::span<const std::uint8_t>)>& callback) {
  Statement& read = store_->read_tasks;
  ResetAtEnd reset(read);
  for (;;) {
    auto row = read.step();
    if (!row) return store_->failed_to("read the tasks", row.error());
    if (!*row || !callback(read.integer(0), read.bytes(1))) return Done{};
  }
}

Status FrameLog::for_each(std::int64_t from_sequence,
                          const std::function<bool(const LoggedFrame&)>& callback) {
  std::int64_t next = from_sequence;
  bool stopped = false;
  const Status read = reader().for_each(from_sequence, [&](const LoggedFrame& frame) {
    next = frame.sequence + 1;
    stopped = !callback(frame);
    return !stopped;
  });
  if (!read && read.error().code == ErrorCode::kConflict)
    return store_->found(read.error().message);
  if (!read) return store_->failed_to("read the frame log", read.error());
  if (!stopped && next <= store_->last_sequence)
    return store_->found("frame " + std::to_string(next) + " is missing");
  return Done{};
}

LogReader FrameLog::reader() { return LogReader(store_->database); }

std::int64_t FrameLog::first_sequence() const { return store_->first_sequence; }

}  // namespace anchord
