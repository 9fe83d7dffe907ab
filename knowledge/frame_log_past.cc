// What a frame log keeps of the past beside frames: configurations, histories, a base.

#include <algorithm>

#include "knowledge/frame_log_store.h"

namespace anchord {

using sqlite::ResetAtEnd;

/// Runs a statement that writes, in the open batch, or one that it begins.
Status FrameLog::write(const char* doing, const char* sql,
                       const std::function<void(Statement&)>& bind) {
  if (store_->batch_lost()) return lost_already();
  if (Status begun = begin_batch(); !begun) return begun;
  auto statement = Statement::prepare(store_->database, sql);
  if (statement) {
    bind(*statement);
    if (auto step = statement->step(); step) return Done{};
  }
  store_->failed = true;
  return store_->not_stored(doing, store_->database.failure("the database failed"));
}

Status FrameLog::put_configuration(const LoggedConfiguration& one) {
  return write("keep the configuration",
               "INSERT OR REPLACE INTO configurations (first, text, checksum) VALUES (?1, ?2, ?3)",
               [&](Statement& statement) {
                 statement.bind(1, one.first)
                     .bind(2, std::string_view(one.text))
                     .bind(3, static_cast<std::int64_t>(checksum(one)));
               });
}

Status FrameLog::put_sample(const HistorySample& sample) {
  return write("keep the history",
               "INSERT OR REPLACE INTO history (object, utime, p, place, x, y, z, spread) "
               "VALUES (?1, ?2, ?3, nullif(?4, ''), ?5, ?6, ?7, ?8)",
               [&](Statement& statement) {
                 statement.bind(1, std::string_view(sample.object))
                     .bind(2, sample.utime)
                     .bind(3, sample.p)
                     .bind(4, std::string_view(sample.place))
                     .bind(5, sample.position[0])
                     .bind(6, sample.position[1])
                     .bind(7, sample.position[2])
                     .bind(8, sample.spread);
               });
}

Result<std::int64_t> FrameLog::thin_history(double grain, Utime until, std::int64_t most) {
  const Utime span = from_seconds(grain);
  auto ask = Statement::prepare(store_->database, "SELECT until FROM thinned WHERE grain = ?1");
  if (!ask) return store_->failed_to("read the history", ask.error());
  auto row = ask->bind(1, span).step();
  if (!row) return store_->failed_to("read the history", row.error());
  const Utime from = *row ? ask->integer(0) : 0;
  ask->reset();
  auto reach = Statement::prepare(store_->database,
                                  "SELECT utime FROM history WHERE utime >= ?1 AND utime < ?2 "
                                  "ORDER BY utime LIMIT 1 OFFSET ?3");
  if (!reach) return store_->failed_to("read the history", reach.error());
  row = reach->bind(1, from).bind(2, until).bind(3, most).step();
  if (!row) return store_->failed_to("read the history", row.error());
  const Utime to = *row ? std::max(reach->integer(0), from + 1) : until;
  reach->reset();
  if (to <= from) return std::int64_t{0};
  // Goes: what follows another of its stretch, and is in the same place as the one before it.
  const Status thinned =
      write("thin the history",
            "DELETE FROM history WHERE utime >= ?1 AND utime < ?2 AND EXISTS ("
            "SELECT 1 FROM history AS earlier WHERE earlier.object = history.object "
            "AND earlier.utime < history.utime AND earlier.utime / ?3 = history.utime / ?3) "
            "AND place IS (SELECT before.place FROM history AS before "
            "WHERE before.object = history.object AND before.utime < history.utime "
            "ORDER BY before.utime DESC LIMIT 1)",
            [&](Statement& s) { s.bind(1, from).bind(2, to).bind(3, span); });
  if (!thinned) return thinned.error();
  const auto gone = store_->database.read_integer("SELECT changes()");
  const Status noted =
      write("thin the history", "INSERT OR REPLACE INTO thinned (grain, until) VALUES (?1, ?2)",
            [&](Statement& s) { s.bind(1, span).bind(2, to); });
  if (!noted) return noted.error();
  return gone;
}

Status FrameLog::forget_history(Utime from) {
  return write("forget the history", "DELETE FROM history WHERE utime >= ?1",
               [&](Statement& s) { s.bind(1, from); });
}

Status FrameLog::put_base(const LogBase& base) {
  const StoredCheckpoint& c = base.checkpoint;
  const Status kept =
      write("keep what the log's beginning was folded into",
            "INSERT INTO base (sequence, first_kept, utime, frame_checksum, configuration, bytes, "
            "checksum) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)",
            [&](Statement& statement) {
              statement.bind(1, c.sequence)
                  .bind(2, base.first_kept)
                  .bind(3, c.utime)
                  .bind(4, static_cast<std::int64_t>(c.frame_checksum))
                  .bind(5, static_cast<std::int64_t>(c.configuration))
                  .bind(6, std::span<const std::uint8_t>(c.bytes))
                  .bind(7, static_cast<std::int64_t>(checksum(base)));
            });
  if (!kept) return kept;
  const Status alone = write("drop an older base", "DELETE FROM base WHERE sequence < ?1",
                             [&](Statement& s) { s.bind(1, c.sequence); });
  if (!alone) return alone;
  if (store_->last_sequence == 0) {
    store_->first_sequence = base.first_kept;
    store_->last_sequence = base.first_kept - 1;
  }
  return Done{};
}

Result<std::int64_t> FrameLog::drop(std::int64_t most) {
  const auto kept = store_->database.read_integer("SELECT coalesce(max(first_kept), 1) FROM base");
  if (!kept) return store_->failed_to("read the frame log", kept.error());
  // Never the last one: by it is seen that the log has come to what was acknowledged.
  const std::int64_t next = std::min({*kept, store_->first_sequence + most, store_->last_sequence});
  const std::int64_t count = next - store_->first_sequence;
  if (count <= 0) return std::int64_t{0};
  const Status dropped = write("drop old frames", "DELETE FROM frames WHERE sequence < ?1",
                               [&](Statement& s) { s.bind(1, next); });
  if (!dropped) return dropped.error();
  store_->first_sequence = next;
  return count;
}

Result<FrameLog::Size> FrameLog::size() {
  Database& database = store_->database;
  const auto page = database.read_integer("PRAGMA page_size");
  const auto pages = database.read_integer("PRAGMA page_count");
  const auto free = database.read_integer("PRAGMA freelist_count");
  for (const auto* number : {&page, &pages, &free})
    if (!*number) return store_->failed_to("read the frame log", number->error());
  return Size{(*pages - *free) * *page, *free * *page};
}

}  // namespace anchord
