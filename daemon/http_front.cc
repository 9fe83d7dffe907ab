#include "daemon/http_front.h"

#include "api/frame_json.h"
#include "daemon/openapi.h"

namespace anchord {
namespace {

bool is_json(const std::string& content_type) {
  const std::string type = content_type.substr(0, content_type.find(';'));
  return type == "application/json" || type == "application/json ";
}

void receive_frames(const HttpRequest& request, HttpReply reply, Journal& journal,
                    Statistics& statistics) {
  if (!is_json(request.content_type))
    return reply(http_error(415, "unsupported_media_type",
                            "send the frames with Content-Type: application/json",
                            "Content-Type"));
  auto frames = parse_frames(request.body);
  if (!frames) {
    ++statistics.refused;
    return reply(http_error(frames.error()));
  }
  Submission submission;
  submission.array = request.body.find_first_not_of(" \t\r\n") != std::string::npos &&
                     request.body[request.body.find_first_not_of(" \t\r\n")] == '[';
  submission.frames = std::move(*frames);
  submission.origin = "HTTP";
  submission.done = [reply](Result<Receipt> receipt) {
    if (!receipt) return reply(http_error(receipt.error()));
    Json body{{"accepted", receipt->accepted}};
    if (receipt->repeated > 0) body["repeated"] = receipt->repeated;
    reply({200, "application/json", body.dump() + "\n", {}});
  };
  if (submission.frames.empty()) return submission.done(Receipt{});
  if (!journal.submit(std::move(submission))) {
    ++statistics.overrun;
    reply(http_error(503, "overloaded", "too many frames wait to be applied; send this again"));
  }
}

}  // namespace

HttpResponse answer_get(const HttpTarget& target, const Journal& journal,
                        const std::atomic<bool>& ready, const SelfDescription& self) {
  if (target.path == "/v1/status") return self.status();
  if (target.path == "/metrics") return self.metrics();
  if (target.path == "/v1/openapi.json") return {200, "application/json", kOpenApi, {}};
  if (!ready)
    return http_error(503, "restoring", "the belief is being restored from the log; ask again");
  return answer(target, journal.snapshot());
}

HttpHandler http_routes(Journal& journal, const std::atomic<bool>& ready, Statistics& statistics,
                        SelfDescription self) {
  return [&journal, &ready, &statistics, self = std::move(self)](HttpRequest request,
                                                                 HttpReply reply) {
    if (request.target.path == "/v1/detections") {
      if (request.method != "POST") {
        HttpResponse refusal = http_error(405, "method_not_allowed", "frames are sent with POST");
        refusal.headers.emplace_back("Allow", "POST");
        return reply(std::move(refusal));
      }
      if (!ready)
        return reply(http_error(503, "restoring",
                                "the belief is being restored from the log; send this again"));
      return receive_frames(request, std::move(reply), journal, statistics);
    }
    if (request.method != "GET") {
      HttpResponse refusal = http_error(405, "method_not_allowed", "questions are asked with GET");
      refusal.headers.emplace_back("Allow", "GET, HEAD");
      return reply(std::move(refusal));
    }
    ++statistics.queries;
    reply(answer_get(request.target, journal, ready, self));
  };
}

}  // namespace anchord
