#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "knowledge/frame_log.h"
#include "knowledge/page_rows.h"

namespace anchord {

/// What is whole of a damaged log beside frames and tasks: configurations, the base, histories.
class SavedPast {
 public:
  /// Takes a row of any table, if it is one of these that is whole. Histories bear no checksum:
  /// what can be one is.
  void take(std::int64_t number, std::span<const StoredValue> row);

  /// The base whose frames the log must hold from LogBase::first_kept on; nothing if the log was
  /// whole, or it is lost.
  const std::optional<LogBase>& base() const { return base_; }
  /// The configuration that is in force at a number of the old log, if it is another than at the
  /// last call's; numbers ascend.
  std::optional<std::string> change_at(std::int64_t number);
  /// Puts the histories up to `until` into a new log.
  Status write_history(FrameLog& log, Utime until) const;

 private:
  std::optional<LogBase> base_;
  std::map<std::int64_t, std::string> configurations_;  ///< by their first number
  std::int64_t told_ = 0;                               ///< the first number of the last one told
  std::map<std::pair<std::string, Utime>, HistorySample> history_;
};

}  // namespace anchord
