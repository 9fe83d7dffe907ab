#include "daemon/verification_routes.h"

#include <charconv>
#include <string_view>
#include <utility>

#include "api/event_json.h"
#include "api/replies.h"
#include "api/verification_json.h"
#include "daemon/http_front.h"

namespace anchord {
namespace {

constexpr std::string_view kRoot = "/v1/verifications";

/// What follows the root: a task's number and, behind a slash, what is wanted of it.
struct TaskPath {
  std::int64_t id = 0;
  std::string_view rest;
};

std::optional<TaskPath> task_path(std::string_view path) {
  path.remove_prefix(kRoot.size());
  if (path.size() < 2 || path[0] != '/') return std::nullopt;
  path.remove_prefix(1);
  TaskPath out;
  const auto [end, error] = std::from_chars(path.data(), path.data() + path.size(), out.id);
  if (error != std::errc() || out.id < 1) return std::nullopt;
  path.remove_prefix(static_cast<std::size_t>(end - path.data()));
  if (!path.empty() && path[0] != '/') return std::nullopt;
  out.rest = path;
  return out;
}

HttpResponse no_such_path() {
  return http_error({ErrorCode::kUnknown, "",
                     "verifications are /v1/verifications, /v1/verifications/{id} and "
                     "/v1/verifications/{id}/result"});
}

HttpResponse json_response(int status, const Json& body) {
  return {status, "application/json", body.dump() + "\n", {}};
}

Verifications::TaskDone answer_with(HttpReply reply, int status) {
  return [reply = std::move(reply), status](const Result<std::optional<Task>>& task) {
    if (!task) return reply(http_error(task.error()));
    if (!*task) return reply(json_response(200, {{"id", nullptr}, {"state", "not needed"}}));
    Json body = to_json(**task);
    HttpResponse response = json_response(status, body);
    if (status == 201)
      response.headers.emplace_back("Location",
                                    std::string(kRoot) + "/" + std::to_string((*task)->id));
    reply(response);
  };
}

}  // namespace

Event with_robot(Event event, Robots& robots) {
  const bool done_by_robot =
      event.kind == Event::Kind::kGrasped || event.kind == Event::Kind::kPlaced;
  if (!done_by_robot) return event;
  if (event.robot.empty())  // the only one
    if (const auto all = robots.all(); all.size() == 1) event.robot = all.front().robot;
  if (event.position || !event.place.empty()) return event;
  if (const auto robot = robots.find(event.robot)) event.position = robot->pose.position;
  return event;
}

void receive_event(const HttpRequest& request, const HttpReply& reply, Journal& journal,
                   Robots& robots) {
  auto event = parse_event(request.body, journal.snapshot().background->dims);
  if (!event) return reply(http_error(event.error()));
  Submission submission{{}, kHttpOrigin, false, {}};
  submission.events = {with_robot(*std::move(event), robots)};
  submission.done = [reply](const Result<Receipt>& receipt) {
    if (!receipt) return reply(http_error(receipt.error()));
    const std::int64_t number = receipt->events.front();
    reply(json_response(200, number > 0 ? Json{{"accepted", 1}, {"number", number}}
                                        : Json{{"accepted", 0}, {"repeated", 1}}));
  };
  if (!journal.submit(std::move(submission)))
    reply(http_error(503, "overloaded", "too much waits to be applied; send this again"));
}

void receive_verification(const HttpRequest& request, const HttpReply& reply,
                          Verifications& verifications) {
  if (request.target.path == kRoot) {
    if (request.method != "POST")
      return reply(http_error(405, "method_not_allowed",
                              "name the task to cancel: DELETE /v1/verifications/{id}"));
    const auto trigger = parse_trigger(request.body);
    if (!trigger) return reply(http_error(trigger.error()));
    return verifications.trigger(*trigger, answer_with(reply, 201));
  }
  const auto path = task_path(request.target.path);
  if (!path) return reply(no_such_path());
  if (request.method == "DELETE" && path->rest.empty())
    return verifications.cancel(path->id, answer_with(reply, 200));
  if (request.method != "POST" || path->rest != "/result") return reply(no_such_path());
  const auto result = parse_result(request.body, path->id);
  if (!result) return reply(http_error(result.error()));
  verifications.result(*result, answer_with(reply, 200));
}

HttpResponse verification_answer(const HttpTarget& target, const Verifications& verifications) {
  if (!target.parameters.empty())
    return http_error(invalid(target.parameters.front().first, "is not a parameter of this call"));
  if (target.path == kRoot) {
    Json list = Json::array();
    for (const Task& task : verifications.tasks()) list.emplace_back(to_json(task));
    return json_response(200, {{"verifications", std::move(list)}});
  }
  const auto path = task_path(target.path);
  if (!path || !path->rest.empty()) return no_such_path();
  const auto task = verifications.find(path->id);
  if (!task)
    return http_error({ErrorCode::kUnknown, "id", "there is no task " + std::to_string(path->id)});
  return json_response(200, to_json(*task));
}

}  // namespace anchord
