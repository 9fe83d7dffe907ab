#include "knowledge/log_repair.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "knowledge/commit_mark.h"
#include "knowledge/data_directory.h"
#include "knowledge/database_pages.h"
#include "knowledge/frame_log.h"
#include "knowledge/page_rows.h"
#include "knowledge/saved_past.h"

namespace anchord {
namespace {

namespace fs = std::filesystem;
using Row = std::span<const StoredValue>;
using Kind = StoredValue::Kind;

/// Whether a row's columns from `first` on are of these kinds.
bool are(Row row, std::size_t first, std::initializer_list<Kind> kinds) {
  return row.size() >= first + kinds.size() &&
         std::equal(kinds.begin(), kinds.end(), row.begin() + static_cast<std::ptrdiff_t>(first),
                    [](Kind kind, const StoredValue& value) { return value.kind == kind; });
}

/// The frame that a row of the table `frames` holds, of whichever version; nothing if it is none
/// that is whole.
std::optional<LoggedFrame> frame_in(std::int64_t number, Row row, const RepairOptions& options) {
  if (number < 1 ||
      !are(row, 0, {Kind::kNull, Kind::kInteger, Kind::kText, Kind::kText, Kind::kBytes}))
    return {};
  LoggedFrame frame;
  frame.sequence = number;
  frame.utime = row[1].integer;
  frame.robot = row[2].text();
  frame.sensor = row[3].text();
  frame.bytes.assign(row[4].bytes.begin(), row[4].bytes.end());
  if (row.size() > 5) frame.kind = static_cast<LoggedFrame::Kind>(row[5].integer);
  if (row.size() > 6 && row[6].kind == Kind::kInteger) frame.work = row[6].integer;
  const bool whole = row.size() > 7 && row[7].kind == Kind::kInteger
                         ? row[7].integer == checksum(frame)
                         : options.readable(frame);
  if (!whole) return {};
  return frame;
}

struct SavedTask {
  bool ended;
  std::vector<std::uint8_t> bytes;
};

/// What is whole in a damaged log.
class Salvage {
 public:
  Salvage(DatabasePages pages, const RepairOptions& options)
      : pages_(std::move(pages)), options_(options) {}

  /// `committed`: the number that the log is known to have come to, or 0.
  void search(std::int64_t committed) {
    search(true);
    if (committed == 0 || places_.empty() || places_.back().sequence < committed) search(false);
  }

  bool empty() const { return places_.empty(); }
  std::int64_t last() const { return places_.empty() ? 0 : places_.back().sequence; }

  /// Copies it, and says so in the report.
  Status write(FrameLog& log, std::int64_t committed, RepairReport& report) {
    constexpr std::int64_t kBatch = 1000;
    std::int64_t before = 0;  // the numbers that the new log begins after
    if (past_.base()) {
      if (options_.until && *options_.until < past_.base()->checkpoint.utime)
        return Error{ErrorCode::kConflict, "--until",
                     "lies before what the log's beginning was folded into"};
      report.base_lost = !base_holds();
      if (!report.base_lost) {
        before = past_.base()->first_kept - 1;
        if (Status put = log.put_base(*past_.base()); !put) return put;
      }
    }
    std::int64_t expected = before + 1;
    for (const Place& place : places_) {
      if (place.sequence <= before) continue;
      if (place.sequence > expected) report.lost.push_back({expected, place.sequence - 1});
      expected = place.sequence + 1;
      LoggedFrame frame = read(place);
      if ((options_.until && frame.utime > *options_.until) ||
          (!options_.events && frame.kind == LoggedFrame::Kind::kEvent)) {
        ++report.left_out;
        continue;
      }
      const bool all_before = place.sequence == before + report.saved + 1;
      if (!all_before && !options_.doubtful_events && frame.kind == LoggedFrame::Kind::kEvent) {
        ++report.left_out;
        ++report.doubtful;
        continue;
      }
      if (const auto configuration = past_.change_at(place.sequence))
        if (Status put = log.put_configuration({before + report.saved + 1, *configuration}); !put)
          return put;
      frame.sequence = before + ++report.saved;
      Status appended = log.append(frame);
      // Two rows of one sensor and time: of an index that was damaged already, or a failed batch.
      if (!appended && appended.error().code == ErrorCode::kConflict) {
        --report.saved;
        report.lost.push_back({place.sequence, place.sequence});
        continue;
      }
      if (appended && report.saved % kBatch == 0) appended = log.commit();
      if (!appended) return appended;
    }
    if (committed >= expected) report.lost.push_back({expected, committed});
    for (const auto& [id, task] : tasks_) {
      if (Status put = log.put_task(id, task.ended, task.bytes); !put) return put;
      ++report.tasks;
    }
    if (Status put = past_.write_history(log, options_.until.value_or(kLatestUtime)); !put)
      return put;
    return log.commit();
  }

 private:
  struct Place {
    std::int64_t sequence, image;
  };

  void search(bool committed) {
    for (std::int64_t i = 0; i < pages_.images(); ++i) {
      if (pages_.committed(i) != committed || pages_.page_of(i) == 1) continue;  // 1: the schema
      const auto page = pages_.image(i);
      if (!page) continue;
      for_each_row(*page, pages_, [&](std::int64_t number, Row row) {
        if (frame_in(number, row, options_)) places_.push_back({number, i});
        past_.take(number, row);
        if (row.size() == 3 && are(row, 0, {Kind::kNull, Kind::kInteger, Kind::kBytes}))
          tasks_[number] = {row[1].integer != 0, {row[2].bytes.begin(), row[2].bytes.end()}};
      });
    }
    const auto order = [](const Place& a, const Place& b) { return a.sequence < b.sequence; };
    std::stable_sort(places_.begin(), places_.end(), order);
    const auto same = [](const Place& a, const Place& b) { return a.sequence == b.sequence; };
    places_.erase(std::unique(places_.begin(), places_.end(), same), places_.end());
  }

  LoggedFrame read(const Place& place) const {
    LoggedFrame frame;
    for_each_row(*pages_.image(place.image), pages_, [&](std::int64_t number, Row row) {
      if (number != place.sequence) return;
      if (auto found = frame_in(number, row, options_)) frame = *std::move(found);
    });
    return frame;
  }

  /// Whether the frames are there before which late ones may have their place in the base.
  bool base_holds() const {
    const LogBase& base = *past_.base();
    std::int64_t next = base.first_kept;
    for (const Place& place : places_)
      if (place.sequence == next && next <= base.checkpoint.sequence) {
        if (next == base.checkpoint.sequence &&
            checksum(read(place)) != base.checkpoint.frame_checksum)
          return false;
        ++next;
      }
    return next == base.checkpoint.sequence + 1;
  }

  DatabasePages pages_;
  const RepairOptions& options_;
  SavedPast past_;
  std::vector<Place> places_;  ///< in order of sequence, each once
  std::map<std::int64_t, SavedTask> tasks_;
};

std::string unused(const std::string& prefix) {
  for (int n = 1;; ++n)
    if (std::string name = prefix + std::to_string(n); !fs::exists(name)) return name;
}

/// Puts the new log's files in the place of the old ones, which get other names. The mark comes
/// last: until then a start finds less than was acknowledged, and refuses.
Status replace(const std::string& database, const std::string& made, const std::string& kept) {
  std::error_code error;
  if (fs::exists(database + "-mark")) fs::copy_file(database + "-mark", kept + "-mark", error);
  // The WAL first: with another database it would be taken for that one's.
  for (const char* part :
       {"-wal", "-shm", "-checkpoints-wal", "-checkpoints-shm", "-checkpoints", ""})
    if (fs::exists(database + part) && !error) fs::rename(database + part, kept + part, error);
  if (!error) fs::rename(made, database, error);
  if (fs::exists(made + "-mark")) {
    if (!error) fs::rename(made + "-mark", database + "-mark", error);
  } else if (!error) {
    fs::remove(database + "-mark", error);  // there is a copy
  }
  if (error)
    return Error{ErrorCode::kIo, "",
                 "cannot rename: " + error.message() + "; the old log is " + database + " or " +
                     kept + ", the new one " + made};
  const int directory = ::open(fs::path(database).parent_path().c_str(), O_RDONLY | O_CLOEXEC);
  if (directory >= 0) {
    ::fsync(directory);
    ::close(directory);
  }
  return Done{};
}

}  // namespace

Result<RepairReport> repair_log(const std::string& directory, const RepairOptions& options) {
  const std::string database = directory + "/anchord.db";
  if (!fs::exists(database))
    return Error{ErrorCode::kUnknown, "", "there is no anchord.db in " + directory};
  const auto lock = DirectoryLock::take(directory);
  if (!lock) return lock.error();
  auto pages = DatabasePages::open(database);
  if (!pages) return pages.error();
  const std::int64_t committed = CommitMark(database + "-mark").read();
  Salvage salvage(*std::move(pages), options);
  salvage.search(committed);
  if (salvage.empty())
    return Error{ErrorCode::kConflict, "", database + " holds no frame that could be saved"};

  RepairReport report;
  const std::string workshop = unused(directory + "/repair-");
  Status made = Done{};
  {
    auto log = FrameLog::open(workshop);
    made = log ? salvage.write(**log, committed, report) : Status(log.error());
  }
  // What closing it could not move into the database, for want of room, would be lost.
  std::error_code none;
  if (made && fs::file_size(workshop + "/anchord.db-wal", none) > 0 && !none)
    made = Error{ErrorCode::kStorage, "", "the disk is too full for a new database"};
  if (made) {
    report.kept_as = unused(database + ".corrupt-");
    made = replace(database, workshop + "/anchord.db", report.kept_as);
  }
  std::error_code left;
  if (made || made.error().code != ErrorCode::kIo) fs::remove_all(workshop, left);
  if (!made) return made.error();
  return report;
}

}  // namespace anchord
