#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/time.h"
#include "knowledge/logged_frame.h"

namespace anchord {

struct RepairOptions {
  /// Whether the log's reader can make out what a frame or event says; asked of those that bear no
  /// checksum, from before version 4.
  std::function<bool(const LoggedFrame&)> readable;
  std::optional<Utime> until = {};  ///< leaves out what is of a later time
  bool events = true;               ///< false: leaves them out
  /// false: leaves out events that stand behind something that is lost or left out. What they name,
  /// other events by number and objects counted by birth, may be something else then.
  bool doubtful_events = true;
};

struct RepairReport {
  std::int64_t saved = 0;  ///< frames and events
  std::int64_t tasks = 0;
  std::int64_t left_out = 0;  ///< by the options
  std::int64_t doubtful = 0;  ///< of these, those of RepairOptions::doubtful_events
  struct Range {
    std::int64_t first, last;
    bool operator==(const Range&) const = default;
  };
  std::vector<Range> lost;  ///< by their number in the old log
  /// What the log's beginning was folded into is lost: the belief begins with the frames that are.
  bool base_lost = false;
  std::string kept_as;  ///< path of the old database
};

/// Makes a new frame log out of what is whole in the one in `directory`, and puts it in its place.
/// Looks at every page by itself, so that no frame is lost but on a damaged page. The frames keep
/// their order and are numbered anew from 1. The old files stay beside it, as
/// `anchord.db.corrupt-N`, unchanged.
/// Errors: kUnavailable: a process holds the log; kUnknown: there is none; kConflict: nothing can
/// be saved; kIo, kStorage: the disk failed. The old log stands in its place then, unless it says
/// otherwise.
Result<RepairReport> repair_log(const std::string& directory, const RepairOptions& options);

}  // namespace anchord
