#include "answers.h"

#include <algorithm>
#include <chrono>

#include "lcmtypes/channels.h"
#include "lcmtypes/verification_codec.h"

namespace anchord {

VerificationResult Answers::result(const Task& task, VerificationResult::Outcome outcome,
                                   const Sighting& sighting, const TimedPicture& picture) {
  VerificationResult result;
  result.task = task.id;
  result.outcome = outcome;
  result.utime = picture.utime;
  result.robot = robot_;
  result.sensor = sensor_;
  if (outcome != VerificationResult::Outcome::kFound) return result;
  Frame frame;
  // Frames of one sensor come in time order: of two objects in one picture the second comes a
  // microsecond later.
  frame.utime = std::max(picture.utime, last_frame_ + 1);
  frame.robot = robot_;
  frame.sensor = sensor_;
  frame.pose = picture.picture.pose;  // whose error the detection does not have yet
  frame.view = View{};  // none: that nothing else is reported does not mean that it is not there
  frame.detections = {*sighting.detection};
  last_frame_ = result.utime = frame.utime;
  result.frame = std::move(frame);
  return result;
}

Status Answers::look(const TimedPicture& picture) {
  using Outcome = VerificationResult::Outcome;
  const std::vector<Task> tasks = tasks_.open(picture.utime);
  if (!tasks.empty()) ++totals_.pictures;
  for (const Task& task : tasks) {
    const auto begun = std::chrono::steady_clock::now();
    const Sighting sighting = verifier_.look(picture.picture, task);
    totals_.seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    totals_.looked_at += sighting.looked_at;
    ++totals_.looks;
    const auto outcome = tasks_.looked(task.id, sighting);
    if (!outcome) continue;
    totals_.found += *outcome == Outcome::kFound;
    totals_.missing += *outcome == Outcome::kMissing;
    totals_.occluded += *outcome == Outcome::kOccluded;
    const auto bytes = encode(result(task, *outcome, sighting, picture));
    if (Status done = bus_.publish(kResultChannel, bytes); !done) return done;
  }
  return Done{};
}

}  // namespace anchord
