// A planner that has the robot look before it grabs: it announces the grab, waits until the
// verification task has ended, grabs if the object was found, and tells that it holds it.
//
//     verify_before_grab OBJECT [ROBOT]

#include <algorithm>
#include <anchord/event_t.hpp>
#include <anchord/rejected_t.hpp>
#include <anchord/verify_task_t.hpp>
#include <anchord/verify_trigger_t.hpp>
#include <chrono>
#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <optional>
#include <string>

namespace {

using anchord::verify_task_t;

constexpr double kTimeout_s = 60;  // for the look

std::int64_t now_utime() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// Hears what becomes of one trigger, known by its tag.
class Look {
 public:
  Look(lcm::LCM& lcm, std::int64_t tag) : tag_(tag) {
    lcm.subscribe("ANCHORD_VERIFY_TASK", &Look::task, this);
    lcm.subscribe("ANCHORD_REJECTED", &Look::rejected, this);
  }

  std::optional<verify_task_t> ended;  ///< the task as it ended
  std::int64_t heard_at = 0;
  bool refused = false;

 private:
  void task(const lcm::ReceiveBuffer*, const std::string&, const verify_task_t* task) {
    const auto& tags = task->tags;
    if (std::find(tags.begin(), tags.end(), tag_) == tags.end()) return;  // another planner's
    if (task->state < verify_task_t::FOUND) return;
    ended = *task;
    heard_at = now_utime();
  }
  void rejected(const lcm::ReceiveBuffer*, const std::string&, const anchord::rejected_t* why) {
    if (why->channel != "ANCHORD_VERIFY_TRIGGER") return;
    std::printf("refused: %s: %s\n", why->field.c_str(), why->reason.c_str());
    refused = true;  // it has no tag: perhaps another's
  }

  const std::int64_t tag_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fputs("usage: verify_before_grab OBJECT [ROBOT]\n", stderr), 2;
  lcm::LCM lcm;
  if (!lcm.good()) return std::fputs("verify_before_grab: LCM cannot be opened\n", stderr), 1;

  anchord::verify_trigger_t trigger{};
  trigger.utime = now_utime();
  trigger.object = argv[1];
  trigger.action = "grab";
  trigger.robot = argc > 2 ? argv[2] : "";
  trigger.timeout_s = kTimeout_s;
  trigger.tag = trigger.utime;  // any number that nobody else has
  Look look(lcm, trigger.tag);
  lcm.publish("ANCHORD_VERIFY_TRIGGER", &trigger);
  // LCM promises nothing: a message may be lost.
  const std::int64_t until = now_utime() + static_cast<std::int64_t>((kTimeout_s + 2) * 1e6);
  while (!look.ended && !look.refused && now_utime() < until) lcm.handleTimeout(200);
  if (look.refused) return 1;
  if (!look.ended) return std::fputs("nothing was heard of the look\n", stderr), 1;

  std::printf("%s: %s\n", look.ended->object.c_str(), look.ended->reason.c_str());
  if (look.ended->state != verify_task_t::FOUND) return 1;
  // Here your robot grabs it; tell so only if that went well.
  anchord::event_t event{};
  // The world's time may be a recording's: it goes on from when the task had ended.
  event.utime = look.ended->ended + now_utime() - look.heard_at;
  event.kind = anchord::event_t::GRASPED;
  event.robot = trigger.robot;
  event.object = look.ended->object;
  if (lcm.publish("ANCHORD_EVENT", &event) != 0) return 1;
  std::printf("%s is grasped\n", event.object.c_str());
}
