#pragma once

#include <cstddef>
#include <string>

#include "api/lcm_bus.h"
#include "core/verification.h"
#include "image_inbox.h"
#include "perception/verifier.h"
#include "task_list.h"

namespace anchord {

/// Looks for what is asked and tells it.
class Answers {
 public:
  struct Totals {
    std::size_t pictures = 0;  ///< in which something was looked for
    std::size_t looks = 0, found = 0, missing = 0, occluded = 0;
    double looked_at = 0;  ///< sum over looks of the share of the picture
    double seconds = 0;    ///< spent looking
  };

  /// The list, the verifier and the bus outlive this.
  Answers(std::string robot, std::string sensor, TaskList& tasks, Verifier& verifier, LcmBus& bus)
      : robot_(std::move(robot)),
        sensor_(std::move(sensor)),
        tasks_(tasks),
        verifier_(verifier),
        bus_(bus) {}

  /// Looks once for every task that is open at the time of the picture, and publishes what is
  /// decided. Fails if it cannot be published.
  Status look(const TimedPicture& picture);

  const Totals& totals() const { return totals_; }

 private:
  VerificationResult result(const Task& task, VerificationResult::Outcome outcome,
                            const Sighting& sighting, const TimedPicture& picture);

  std::string robot_, sensor_;
  TaskList& tasks_;
  Verifier& verifier_;
  LcmBus& bus_;
  Totals totals_;
  Utime last_frame_ = 0;
};

}  // namespace anchord
