#pragma once

#include <functional>
#include <string>

#include "core/result.h"
#include "tools/anchorctl/fields.h"
#include "tools/anchorctl/http_client.h"

namespace anchord {

/// An answer of the daemon: its bytes, and what they say.
struct Answer {
  std::string text;
  Json json;
};

/// What `server` answered, or its refusal in the words of its error with its field: kUnavailable
/// where trying again may help (5xx, 408, 429), else kUnknown (404) or kInvalid.
Result<Answer> read_answer(HttpAnswer answer, const ServerAddress& server);

/// http_exchange() and read_answer(). `stopped` as there.
Result<Answer> ask(const ServerAddress& server, const HttpCall& request,
                   const std::function<bool()>& stopped);

}  // namespace anchord
