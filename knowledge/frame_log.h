#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "core/time.h"
#include "knowledge/log_reader.h"
#include "knowledge/logged_frame.h"

namespace anchord {

/// The log of accepted frames: the truth from which the belief is folded. It is a SQLite database,
/// `anchord.db`, in a directory of its own, which one process holds at a time (`anchord.lock`).
/// Other programs may read the database meanwhile.
///
/// The log keeps the order of acceptance. The belief is a function of the frames in the order
/// (utime, sequence), and a frame may be accepted late; whoever folds the log in order of sequence
/// puts late frames in their place just as when they came in, and reaches the same belief.
///
/// A checksum stands beside each; with the numbering, and a note of what was committed last
/// (`anchord.db-mark`), damage is found when the log is opened or what is damaged is read. Closing
/// a log in which damage was found leaves its files as they are.
///
/// Events stand in the same order among the frames. Beside them it keeps the newest record of each
/// verification task, the configurations under which frames came in, and the history of objects.
/// What is old may be given up for a base: the belief that it was folded into.
///
/// Frames are appended in batches. A frame is durable when the commit() of its batch has returned
/// without Error: it then survives a kill of the process and a loss of power. After an Error of
/// append() or commit() (kStorage: the disk is full, or fails) nothing of the batch is kept, every
/// further append() and commit() is refused until rollback(), and the log is usable after that.
///
/// One thread at a time.
class FrameLog {
 public:
  /// The format that this program writes; kept in the database's `user_version`.
  static constexpr int kVersion = 5;

  /// Opens the log in `directory` and creates both if missing. `max_bytes` bounds the database's
  /// size, 0: by the disk alone; at the bound appends fail as on a full disk.
  /// Errors: kIo: the directory cannot be made or written, the disk failed; kUnavailable: another
  /// process holds the log; kConflict: `anchord.db` is of a newer version, of another program, no
  /// database at all, or damaged, as far as that is seen without reading every frame; nothing in it
  /// is changed then.
  static Result<std::unique_ptr<FrameLog>> open(const std::string& directory,
                                                std::int64_t max_bytes = 0);
  /// Rolls back an open batch.
  ~FrameLog();
  FrameLog(const FrameLog&) = delete;
  FrameLog& operator=(const FrameLog&) = delete;

  /// Adds a frame to the open batch, or begins one. kConflict: the sequence does not follow
  /// last_sequence(), or the sensor has a frame of that utime; the batch stands then.
  Status append(const LoggedFrame& frame);
  /// Makes the batch durable. Without a batch there is nothing to do.
  Status commit();
  /// Drops the batch.
  void rollback();

  /// The calls below see the open batch too.

  /// 0 while the log is empty.
  std::int64_t last_sequence() const;
  /// The oldest that the log holds still; 1 unless drop() has dropped some.
  std::int64_t first_sequence() const;
  /// checksum() of what was appended last; 0 before anything was.
  std::uint32_t last_checksum() const;

  enum class Presence { kNo, kSame, kDifferent };
  /// Whether the sensor has a frame of that utime, and if so, whether with these bytes.
  /// Frames only.
  Result<Presence> contains(std::string_view robot, std::string_view sensor, Utime utime,
                            const std::vector<std::uint8_t>& bytes);
  /// Whether the log has this event.
  Result<bool> contains_event(Utime utime, const std::vector<std::uint8_t>& bytes);

  /// Keeps the newest record of a task, in the open batch, or begins one.
  Status put_task(std::int64_t id, bool ended, const std::vector<std::uint8_t>& bytes);
  /// Forgets the ended ones but for the newest `count` tasks, in the open batch, if there is one.
  Status keep_tasks(std::int64_t count);
  /// The records of all tasks, in order of id, until the callback says false.
  Status for_each_task(
      const std::function<bool(std::int64_t id, std::span<const std::uint8_t>)>& callback);

  /// Every frame and event with `sequence >= from_sequence`, from first_sequence() on, in order of
  /// sequence, until the callback says false. The callback must not append. kIo: what follows is
  /// damaged.
  Status for_each(std::int64_t from_sequence,
                  const std::function<bool(const LoggedFrame&)>& callback);
  /// Reads all that the log holds; the log must outlive it.
  LogReader reader();

  /// The calls below add to the open batch, or begin one.

  /// Says from which frame or event on a configuration is in force.
  Status put_configuration(const LoggedConfiguration& configuration);
  /// Keeps a sample of an object's history, in the place of one of the same time.
  Status put_sample(const HistorySample& sample);
  /// Thins the history to `grain` s, from where that came to last up to `until` but over no more
  /// than `most` rows: of each stretch of so many s the first sample stays, and those at which the
  /// place changes. Gives how many rows went.
  Result<std::int64_t> thin_history(double grain, Utime until, std::int64_t most);
  /// Forgets the history from that time on.
  Status forget_history(Utime from);
  /// Puts a base in the place of all before it: drop() may drop that from then on. In an empty log
  /// it says where the log begins.
  Status put_base(const LogBase& base);
  /// Drops at most `most` of the oldest frames and events that the base makes dispensable. Gives
  /// how many.
  Result<std::int64_t> drop(std::int64_t most);
  /// Bytes of the database that are in use, and those that are free to be used again.
  struct Size {
    std::int64_t used = 0, free = 0;
  };
  Result<Size> size();

  struct Store;

 private:
  Status begin_batch();
  Status write(const char* doing, const char* sql,
               const std::function<void(sqlite::Statement&)>& bind);
  explicit FrameLog(std::unique_ptr<Store> store);
  std::unique_ptr<Store> store_;
};

}  // namespace anchord
