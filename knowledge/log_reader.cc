#include "knowledge/log_reader.h"

#include <sqlite3.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <filesystem>
#include <utility>

namespace anchord {

namespace {

using sqlite::Database;
using sqlite::Statement;

/// Frames that are read at once: between, nothing is held.
constexpr std::int64_t kChunk = 256;

constexpr const char* kFrameColumns =
    "SELECT sequence, utime, robot, sensor, bytes, kind, work, checksum FROM frames ";
constexpr const char* kSampleColumns =
    "SELECT object, utime, p, place, x, y, z, spread FROM history ";

Error damaged(std::int64_t sequence, const char* how) {
  return {ErrorCode::kConflict, "", "frame " + std::to_string(sequence) + how};
}

/// The frame of a row of kFrameColumns; kConflict if its checksum is another.
Result<LoggedFrame> frame_of(const Statement& row) {
  LoggedFrame frame;
  frame.sequence = row.integer(0);
  frame.utime = row.integer(1);
  frame.robot = row.text(2);
  frame.sensor = row.text(3);
  const auto bytes = row.bytes(4);
  frame.bytes.assign(bytes.begin(), bytes.end());
  frame.kind = static_cast<LoggedFrame::Kind>(row.integer(5));
  if (!row.is_null(6)) frame.work = row.integer(6);
  if (!row.is_null(7) && row.integer(7) != checksum(frame))
    return damaged(frame.sequence, " is not as it was written");
  return frame;
}

HistorySample sample_of(const Statement& row) {
  HistorySample sample;
  sample.object = row.text(0);
  sample.utime = row.integer(1);
  sample.p = row.real(2);
  sample.place = row.text(3);
  for (int axis = 0; axis < 3; ++axis) sample.position[axis] = row.real(4 + axis);
  sample.spread = row.real(7);
  return sample;
}

std::uint32_t crc_of(const void* bytes, std::size_t size) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes, size);
  return crc.checksum();
}

}  // namespace

std::uint32_t checksum(const StoredCheckpoint& checkpoint) {
  return crc_of(checkpoint.bytes.data(), checkpoint.bytes.size());
}

std::uint32_t checksum(const LoggedConfiguration& configuration) {
  const std::string all = std::to_string(configuration.first) + configuration.text;
  return crc_of(all.data(), all.size());
}

std::uint32_t checksum(const LogBase& base) {
  const StoredCheckpoint& c = base.checkpoint;
  const std::string numbers = std::to_string(c.sequence) + " " + std::to_string(base.first_kept) +
                              " " + std::to_string(c.utime) + " " +
                              std::to_string(c.frame_checksum) + " " +
                              std::to_string(c.configuration) + " " + std::to_string(checksum(c));
  return crc_of(numbers.data(), numbers.size());
}

Result<LogReader> LogReader::open(const std::string& directory) {
  const std::string path = directory + "/anchord.db";
  if (!std::filesystem::exists(path))
    return Error{ErrorCode::kUnknown, "", "there is no anchord.db in " + directory};
  auto database = Database::open_reading(path);
  if (!database) return database.error();
  sqlite3_busy_timeout(database->handle(), 1000);
  auto own = std::make_unique<Database>(*std::move(database));
  LogReader reader(*own);
  reader.own_ = std::move(own);
  return reader;
}

/// SQLite's own word for damage is told as ours is.
Error LogReader::failed(const Error& error) const {
  const int code = database_->extended_code() & 0xff;
  if (code != SQLITE_CORRUPT && code != SQLITE_NOTADB) return error;
  return {ErrorCode::kConflict, error.field, error.message};
}

Result<std::int64_t> LogReader::last_sequence() {
  return database_->read_integer("SELECT coalesce(max(sequence), 0) FROM frames");
}

Result<std::int64_t> LogReader::first_sequence() {
  return database_->read_integer("SELECT coalesce(min(sequence), 1) FROM frames");
}

Status LogReader::for_each(std::int64_t from,
                           const std::function<bool(const LoggedFrame&)>& callback) {
  auto statement = Statement::prepare(
      *database_, std::string(kFrameColumns) + "WHERE sequence >= ?1 ORDER BY sequence LIMIT " +
                      std::to_string(kChunk));
  if (!statement) return failed(statement.error());
  std::vector<LoggedFrame> chunk;
  for (std::int64_t next = from;;) {
    chunk.clear();
    statement->bind(1, next);
    for (;;) {
      auto row = statement->step();
      if (!row) return failed(row.error());
      if (!*row) break;
      auto frame = frame_of(*statement);
      if (!frame) return frame.error();
      chunk.push_back(*std::move(frame));
    }
    statement->reset();
    for (const LoggedFrame& frame : chunk) {
      if (frame.sequence != next) return damaged(next, " is missing");
      ++next;
      if (!callback(frame)) return Done{};
    }
    if (static_cast<std::int64_t>(chunk.size()) < kChunk) return Done{};
  }
}

Result<std::optional<LoggedFrame>> LogReader::at(std::int64_t sequence) {
  auto statement =
      Statement::prepare(*database_, std::string(kFrameColumns) + "WHERE sequence = ?1");
  if (!statement) return failed(statement.error());
  auto row = statement->bind(1, sequence).step();
  if (!row) return failed(row.error());
  if (!*row) return std::optional<LoggedFrame>();
  auto frame = frame_of(*statement);
  if (!frame) return frame.error();
  return std::optional(*std::move(frame));
}

Result<std::vector<LoggedFrame>> LogReader::frames_at(Utime utime) {
  auto statement = Statement::prepare(
      *database_, std::string(kFrameColumns) + "WHERE utime = ?1 AND kind = 0 ORDER BY sequence");
  if (!statement) return failed(statement.error());
  statement->bind(1, utime);
  std::vector<LoggedFrame> frames;
  for (;;) {
    auto row = statement->step();
    if (!row) return failed(row.error());
    if (!*row) return frames;
    auto frame = frame_of(*statement);
    if (!frame) return frame.error();
    frames.push_back(*std::move(frame));
  }
}

Result<std::vector<LoggedConfiguration>> LogReader::configurations() {
  auto statement = Statement::prepare(
      *database_, "SELECT first, text, checksum FROM configurations ORDER BY first");
  if (!statement) return failed(statement.error());
  std::vector<LoggedConfiguration> out;
  for (;;) {
    auto row = statement->step();
    if (!row) return failed(row.error());
    if (!*row) return out;
    out.push_back({statement->integer(0), std::string(statement->text(1))});
    if (statement->integer(2) != checksum(out.back()))
      return Error{ErrorCode::kConflict, "",
                   "the configuration from frame " + std::to_string(out.back().first) +
                       " on is not as it was written"};
  }
}

Result<std::optional<LogBase>> LogReader::base() {
  auto statement = Statement::prepare(*database_,
                                      "SELECT sequence, first_kept, utime, frame_checksum, "
                                      "configuration, bytes, checksum FROM base "
                                      "ORDER BY sequence DESC LIMIT 1");
  if (!statement) return failed(statement.error());
  auto row = statement->step();
  if (!row) return failed(row.error());
  if (!*row) return std::optional<LogBase>();
  LogBase base;
  base.checkpoint.sequence = statement->integer(0);
  base.first_kept = statement->integer(1);
  base.checkpoint.utime = statement->integer(2);
  base.checkpoint.frame_checksum = static_cast<std::uint32_t>(statement->integer(3));
  base.checkpoint.configuration = static_cast<std::uint64_t>(statement->integer(4));
  const auto bytes = statement->bytes(5);
  base.checkpoint.bytes.assign(bytes.begin(), bytes.end());
  if (statement->integer(6) != checksum(base))
    return Error{ErrorCode::kConflict, "",
                 "what the log's beginning was folded into is not as it "
                 "was written"};
  return std::optional(std::move(base));
}

Result<std::vector<HistorySample>> LogReader::history(const HistorySpan& span) {
  auto count = Statement::prepare(
      *database_, "SELECT count(*) FROM history WHERE object = ?1 AND utime BETWEEN ?2 AND ?3");
  if (!count) return failed(count.error());
  count->bind(1, std::string_view(span.object)).bind(2, span.from).bind(3, span.to);
  if (auto row = count->step(); !row) return failed(row.error());
  const std::int64_t there = count->integer(0);
  // Of more than may be given, one in each stretch of time, and where the place changes.
  const std::int64_t most = std::max<std::int64_t>(span.most, 1);
  auto statement = Statement::prepare(
      *database_,
      std::string(kSampleColumns) + "WHERE object = ?1 AND utime BETWEEN ?2 AND ?3 ORDER BY utime");
  if (!statement) return failed(statement.error());
  statement->bind(1, std::string_view(span.object)).bind(2, span.from).bind(3, span.to);
  std::vector<HistorySample> out;
  std::int64_t seen = 0;
  for (;;) {
    auto row = statement->step();
    if (!row) return failed(row.error());
    if (!*row) return out;
    HistorySample sample = sample_of(*statement);
    const bool first_of_stretch = there <= most || seen * most / there != (seen - 1) * most / there;
    ++seen;
    if (first_of_stretch || out.empty() || sample.place != out.back().place)
      out.push_back(std::move(sample));
  }
}

Result<std::optional<HistorySample>> LogReader::last_sample(const std::string& object) {
  auto statement = Statement::prepare(
      *database_, std::string(kSampleColumns) + "WHERE object = ?1 ORDER BY utime DESC LIMIT 1");
  if (!statement) return failed(statement.error());
  auto row = statement->bind(1, std::string_view(object)).step();
  if (!row) return failed(row.error());
  if (!*row) return std::optional<HistorySample>();
  return std::optional(sample_of(*statement));
}

}  // namespace anchord
