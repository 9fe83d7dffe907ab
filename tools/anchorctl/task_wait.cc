#include "tools/anchorctl/task_wait.h"

#include <optional>
#include <utility>

namespace anchord {
namespace {

constexpr double kInterval_s = 0.2;  ///< from one look to the next
constexpr double kPatience_s = 30;   ///< with a daemon that does not answer

}  // namespace

bool has_ended(const Json& task) {
  const std::string state = text(task, "state");
  return state != "queued" && state != "issued";
}

bool went_well(const Json& task) {
  const std::string state = text(task, "state");
  return state == "found" || state == "not needed";
}

Result<Answer> wait_for_end(Answer task, const TaskWaitSeams& seams) {
  if (has_ended(task.json)) return task;
  const Json* id = member(task.json, "id");
  if (!id || !id->is_number_integer()) return invalid("id", "of the task is missing in the answer");
  const std::string number = id->dump();
  std::optional<double> silent_since;
  while (!has_ended(task.json)) {
    if (!seams.wait(kInterval_s))
      return Error{ErrorCode::kUnavailable, "",
                   "stopped waiting; the task goes on (end it with anchorctl verify --cancel " +
                       number + ")"};
    auto answer = seams.fetch("/v1/verifications/" + number);
    if (answer) {
      task = *std::move(answer);
      silent_since.reset();
      continue;
    }
    if (answer.error().code != ErrorCode::kUnavailable) return answer.error();
    if (!silent_since) {
      silent_since = seams.now_s();
      seams.note(answer.error().text() + "; asking again");
    }
    if (seams.now_s() - *silent_since > kPatience_s) return answer.error();
  }
  return task;
}

}  // namespace anchord
