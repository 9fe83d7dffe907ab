#include "daemon/http_front.h"

#include <string_view>
#include <utility>

#include "api/frame_json.h"
#include "daemon/openapi.h"

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

void receive_frames(const HttpRequest& request, const HttpReply& reply, Journal& journal,
                    Statistics& statistics, const RefusedBody& refused) {
  if (!is_json(request.content_type)) {
    ++statistics.refused;
    const std::string message = "send the frames with Content-Type: application/json";
    refused(invalid("Content-Type", message));
    return reply(http_error(415, "unsupported_media_type", message, "Content-Type"));
  }
  auto frames = read_frames(request.body);
  if (!frames) {
    ++statistics.refused;
    refused(frames.error());
    return reply(http_error(frames.error()));
  }
  Submission submission{std::move(*frames), kHttpOrigin, is_array(request.body), {}};
  submission.done = [reply](Result<Receipt> receipt) {
    if (!receipt) return reply(http_error(receipt.error()));
    Json body{{"accepted", receipt->accepted}};
    if (receipt->repeated > 0) body["repeated"] = receipt->repeated;
    reply({200, "application/json", body.dump() + "\n", {}});
  };
  const std::size_t count = submission.frames.size();
  if (count == 0) return submission.done(Receipt{});
  if (!journal.submit(std::move(submission))) {
    statistics.overrun += count;
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

}  // namespace

HttpResponse answer_get(const HttpTarget& target, const Journal& journal,
                        const std::atomic<bool>& ready, const SelfDescription& self) {
  if (target.path == "/v1/status") return self.status();
  if (target.path == "/metrics") return self.metrics();
  if (target.path == "/v1/openapi.json") return {200, "application/json", kOpenApi, {}};
  if (!ready) return not_ready();
  return answer(target, journal.snapshot());
}

HttpHandler http_routes(Journal& journal, const std::atomic<bool>& ready, Statistics& statistics,
                        SelfDescription self, RefusedBody refused) {
  return [&journal, &ready, &statistics, self = std::move(self), refused = std::move(refused)](
             const HttpRequest& request, const HttpReply& reply) {
    if (request.target.path == "/v1/detections") {
      if (request.method != "POST")
        return reply(method_not_allowed("frames are sent with POST", "POST, OPTIONS"));
      if (!ready) return reply(not_ready());
      return receive_frames(request, reply, journal, statistics, refused);
    }
    if (request.method != "GET")
      return reply(method_not_allowed("questions are asked with GET", "GET, HEAD, OPTIONS"));
    ++statistics.queries;
    reply(answer_get(request.target, journal, ready, self));
  };
}

}  // namespace anchord
