#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anchoring/belief.h"
#include "knowledge/history.h"

namespace anchord {

/// Takes down where objects are believed to be, as that changes. One thread at a time.
///
/// Of an object with a name a sample is taken when it appears, moves by more than kLeastMove and
/// half its spread, comes into another place, becomes more or less probable by kLeastChange, or is
/// given up. So what lies still costs nothing.
class HistoryRecorder {
 public:
  static constexpr double kLeastMove = 0.1;     ///< m
  static constexpr double kLeastChange = 0.05;  ///< of p

  /// `grain`: s of world time that lie at least between two looks at the belief.
  explicit HistoryRecorder(double grain) : grain_(grain) {}

  /// What the log has last of an object.
  using LastSample = std::function<std::optional<HistorySample>(const std::string& object)>;

  /// What is to be taken down of a belief; nothing if the last look was less than a grain ago. Only
  /// clusters that have changed since then are looked at.
  std::vector<HistorySample> look(const std::shared_ptr<const Belief>& belief,
                                  const Background& background, const LastSample& last);
  /// The log has not kept what look() gave: everything is asked of it again.
  void forget();

 private:
  double grain_;
  std::shared_ptr<const Belief> seen_;  ///< by the last look
  std::map<std::string, HistorySample> last_;
};

/// An object as it is believed to be at the belief's time, as a sample.
HistorySample sample_of(const struct ObjectBelief& object, Utime utime,
                        const Background& background);

}  // namespace anchord
