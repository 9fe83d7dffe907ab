#include "daemon/http_front.h"

#include <string_view>
#include <utility>

#include "api/at_parameter.h"
#include "api/frame_json.h"
#include "daemon/openapi.h"
#include "daemon/verification_routes.h"

namespace anchord {
namespace {

/// A media type, whatever its parameters and however it is written.
bool is_json(std::string_view content_type) {
  std::string type(content_type.substr(0, content_type.find(';')));
  while (!type.empty() && (type.back() == ' ' || type.back() == '\t')) type.pop_back();
  for (char& c : type)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return type == "application/json";
}

/// Parsed already: what does not begin with a '[' is one frame.
bool is_array(const std::string& json) {
  const auto first = json.find_first_not_of(" \t\r\n");
  return first != std::string::npos && json[first] == '[';
}

/// The frames in a request, or what is wrong with it.
Result<std::vector<Frame>> read_frames(const std::string& body) {
  auto frames = parse_frames(body);
  if (frames && frames->size() > Journal::kQueue)
    return Error{ErrorCode::kTooLarge, "",
                 "has " + std::to_string(frames->size()) + " frames; send at most " +
                     std::to_string(Journal::kQueue) + " at once"};
  return frames;
}

void receive_frames(const HttpRequest& request, const HttpReply& reply,
                    const HttpBackend& backend) {
  auto frames = read_frames(request.body);
  if (!frames) {
    ++backend.statistics.refused;
    backend.refused(frames.error());
    return reply(http_error(frames.error()));
  }
  Submission submission{std::move(*frames), kHttpOrigin, is_array(request.body), {}};
  submission.done = [reply](Result<Receipt> receipt) {
    if (!receipt) return reply(http_error(receipt.error()));
    Json body{{"accepted", receipt->accepted}};
    if (receipt->repeated > 0) body["repeated"] = receipt->repeated;
    reply({200, "application/json", body.dump() + "\n", {}});
  };
  submission.bytes = request.body.size();
  const std::size_t count = submission.frames.size();
  if (count == 0) return submission.done(Receipt{});
  if (!backend.journal.submit(std::move(submission))) {
    backend.statistics.overrun += count;
    reply(http_error(503, "overloaded", "too many frames wait to be applied; send this again"));
  }
}

HttpResponse method_not_allowed(const char* message, const char* allowed) {
  HttpResponse refusal = http_error(405, "method_not_allowed", message);
  refusal.headers.emplace_back("Allow", allowed);
  return refusal;
}

HttpResponse not_ready() {
  return http_error(503, "not_ready",
                    "the daemon is restoring its belief from the log, or ending; try again");
}

/// The configuration that runs, as it was read: what is known of the world before it is seen.
HttpResponse configuration_answer(const HttpTarget& target, const Snapshot& snapshot) {
  if (!target.parameters.empty())
    return http_error(invalid(target.parameters.front().first, "is no parameter of this question"));
  return {200, "application/json", snapshot.background->knowledge.text + "\n", {}};
}

HttpResponse upgrade_required() {
  HttpResponse refusal = http_error(426, "upgrade_required", "ask for a WebSocket here");
  refusal.headers.emplace_back("Upgrade", "websocket");
  return refusal;
}

/// Whether a body may be read as JSON; answers if not.
bool refuse_unless_json(const HttpRequest& request, const HttpReply& reply, const char* what,
                        const HttpBackend& backend) {
  if (is_json(request.content_type)) return false;
  ++backend.statistics.refused;
  const std::string message = std::string("send ") + what + " with Content-Type: application/json";
  backend.refused(invalid("Content-Type", message));
  reply(http_error(415, "unsupported_media_type", message, "Content-Type"));
  return true;
}

bool is_verification(const std::string& path) {
  return path == "/v1/verifications" || path.starts_with("/v1/verifications/");
}

/// What changes something: POST, and DELETE of a task. False: that is none of it.
bool change(const HttpRequest& request, const HttpReply& reply, const HttpBackend& backend) {
  const std::string& path = request.target.path;
  const bool frames = path == "/v1/detections", event = path == "/v1/events";
  const bool verification = is_verification(path) && request.method != "GET";
  if (!frames && !event && !verification) return false;
  if (frames && request.method != "POST") {
    reply(method_not_allowed("frames are sent with POST", "POST, OPTIONS"));
  } else if (event && request.method != "POST") {
    reply(method_not_allowed("events are sent with POST", "POST, OPTIONS"));
  } else if (verification && request.method != "POST" && request.method != "DELETE") {
    reply(method_not_allowed("triggers and results are sent with POST, tasks cancelled with DELETE",
                             "GET, HEAD, POST, DELETE, OPTIONS"));
  } else if (!backend.ready) {
    reply(not_ready());
  } else if (frames) {
    if (!refuse_unless_json(request, reply, "the frames", backend))
      receive_frames(request, reply, backend);
  } else if (request.method == "DELETE" ||
             !refuse_unless_json(request, reply, event ? "the event" : "what is asked", backend)) {
    if (event)
      receive_event(request, reply, backend.journal, backend.robots);
    else
      receive_verification(request, reply, backend.verifications);
  }
  return true;
}

/// Whether a path may be a page's: no file is in the API's way.
bool may_be_page(const std::string& path) {
  return path != "/v1" && !path.starts_with("/v1/") && path != "/metrics";
}

}  // namespace

void answer_get(HttpTarget target, const HttpBackend& backend, const HttpReply& reply) {
  if (target.path == "/v1/status") return reply(backend.self.status());
  if (target.path == "/metrics") return reply(backend.self.metrics());
  if (target.path == "/v1/openapi.json") return reply({200, "application/json", kOpenApi, {}});
  if (target.path == "/v1/configuration")
    return reply(configuration_answer(target, backend.journal.snapshot()));
  if (target.path == "/v1/stream") return reply(upgrade_required());
  if (!backend.ready) return reply(not_ready());
  if (is_verification(target.path))
    return reply(verification_answer(target, backend.verifications));
  const auto at = take_at(target, Journal::clock_time());
  if (!at) return reply(http_error(at.error()));
  if (Archive::concerns(target, *at)) return backend.archive.answer(target, *at, reply);
  reply(answer(target, backend.journal.snapshot()));
}

HttpHandler http_routes(HttpBackend backend) {
  return [backend = std::move(backend)](const HttpRequest& request, const HttpReply& reply) {
    if (change(request, reply, backend)) return;
    if (request.method != "GET")
      return reply(method_not_allowed("questions are asked with GET", "GET, HEAD, OPTIONS"));
    const std::string& path = request.target.path;
    auto page =
        may_be_page(path) ? backend.viewer->answer(path, request.if_none_match) : std::nullopt;
    if (page) return reply(*std::move(page));
    ++backend.statistics.queries;
    answer_get(request.target, backend, reply);
  };
}

HttpDoor front_door(std::optional<BearerToken> token, std::shared_ptr<const StaticFiles> viewer) {
  if (!token) return loopback_door();
  return token_door(*std::move(token), [viewer = std::move(viewer)](std::string_view target) {
    const auto parsed = parse_target(target);
    return parsed && may_be_page(parsed->path) && viewer->has(parsed->path);
  });
}

}  // namespace anchord
