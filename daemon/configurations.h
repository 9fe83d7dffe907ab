#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "anchoring/world.h"
#include "core/result.h"
#include "knowledge/log_reader.h"

namespace anchord {

/// The configurations that a log was written under, in order, each with what the engine derives
/// from it. Of those equal to the one that runs now it is that one's. One thread at a time.
class Configurations {
 public:
  /// Those of the log; `now` is an empty world of the configuration that runs. A log of before
  /// configurations were kept counts as written under that one.
  static Result<Configurations> of(LogReader& log, const World& now);

  /// The one under which the frame or event of that number is folded.
  std::size_t at(std::int64_t sequence) const;
  std::size_t last() const { return logged_.size() - 1; }
  /// Whether the log's last one is the one that runs, or the log is empty.
  bool last_is_now() const { return same_as_now(last()); }
  /// An empty world of one of them. kInvalid: this program cannot read it any more.
  Result<World> empty(std::size_t index);
  /// The one that a checkpoint at `sequence` with this fingerprint was made under, if it is any.
  bool made(std::uint64_t fingerprint, std::int64_t sequence);
  const World& now() const { return now_; }

 private:
  Configurations(std::vector<LoggedConfiguration> logged, const World& now)
      : logged_(std::move(logged)), now_(now) {}
  bool same_as_now(std::size_t index) const;

  std::vector<LoggedConfiguration> logged_;  ///< at least one
  World now_;
  std::map<std::size_t, World> empty_;  ///< those asked for so far
};

}  // namespace anchord
