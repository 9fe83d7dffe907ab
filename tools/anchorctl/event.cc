#include "tools/anchorctl/event.h"

#include <utility>

namespace anchord {

Result<Answer> tell(Json event, const Ask& ask) {
  const auto status = ask({"GET", "/v1/status", ""});
  if (!status) return status.error();
  const auto newest = utime(status->json, "utime");
  if (!newest)
    return Error{ErrorCode::kUnavailable, "", "the daemon has seen no frame yet, so no object"};
  event["utime"] = *newest;
  auto answer =
      ask({"POST", "/v1/events", event.dump(-1, ' ', false, Json::error_handler_t::replace)});
  if (answer && !number(answer->json, "number"))
    return Error{
        ErrorCode::kConflict, "",
        "nothing changed: the same was told before, at the same time; it can be told again "
        "after the next frame"};
  return answer;
}

}  // namespace anchord
