#include "tools/anchorctl/daemon.h"

namespace anchord {
namespace {

constexpr std::chrono::milliseconds kPatience{10'000};

ErrorCode code_of(int status) {
  if (status >= 500 || status == 408 || status == 429) return ErrorCode::kUnavailable;
  return status == 404 ? ErrorCode::kUnknown : ErrorCode::kInvalid;
}

}  // namespace

Result<Answer> read_answer(HttpAnswer answer, const ServerAddress& server) {
  Json json = Json::parse(answer.body, nullptr, false);
  const std::string status = "HTTP " + std::to_string(answer.status) + " from " + server.text();
  if (answer.status < 200 || answer.status > 299) {
    const Json& error = items(json, "error");
    const std::string message = text(error, "message", "the request was refused");
    return Error{code_of(answer.status), text(error, "field", ""), message + " (" + status + ")"};
  }
  if (json.is_discarded()) {
    return Error{ErrorCode::kInvalid, "",
                 "the answer is no JSON (" + status +
                     "): is that anchord? Name another server with --server ADDR:PORT"};
  }
  return Answer{std::move(answer.body), std::move(json)};
}

Result<Answer> ask(const ServerAddress& server, const HttpCall& request,
                   const std::function<bool()>& stopped) {
  auto answer = http_exchange(server, request, kPatience, stopped);
  if (!answer) return answer.error();
  return read_answer(*std::move(answer), server);
}

}  // namespace anchord
