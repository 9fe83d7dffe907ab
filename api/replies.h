#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "api/http_message.h"
#include "core/frame.h"
#include "core/result.h"

namespace anchord {

/// An encoded answer_t, for ANCHORD_ANSWER: what HTTP would answer. `id` is the question's.
std::vector<std::uint8_t> encode_answer(std::int64_t id, const HttpResponse& response);

/// An encoded rejected_t, for ANCHORD_REJECTED. `origin` is where it came in, an LCM channel or
/// HTTP; `frame` what was refused, null if it could not be read; `utime` when it was refused.
std::vector<std::uint8_t> encode_refusal(const std::string& origin, const Frame* frame,
                                         const Error& why, Utime utime);

}  // namespace anchord
