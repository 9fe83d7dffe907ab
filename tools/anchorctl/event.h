#pragma once

#include <functional>

#include "core/result.h"
#include "tools/anchorctl/daemon.h"

namespace anchord {

/// Asks the daemon one thing.
using Ask = std::function<Result<Answer>(const HttpCall&)>;

/// Tells the daemon of an event, at the time of its newest frame: the world may be a recording's,
/// and what people say holds for what they see. Errors: the daemon refuses it, has seen no frame
/// yet, or was told the same since its newest frame.
Result<Answer> tell(Json event, const Ask& ask);

}  // namespace anchord
