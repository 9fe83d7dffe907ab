#pragma once

#include <boost/beast/http.hpp>
#include <optional>
#include <string_view>

#include "api/http_core.h"

namespace anchord {

/// What the server refuses by itself, from a request's bytes and its header. For http_session.cc.

/// What the client gets for a request that cannot be read.
HttpResponse refusal_of(boost::system::error_code error, const HttpLimits& limits);

HttpResponse target_too_long(const HttpLimits& limits);

/// Whether these first bytes, a line that has not ended, hold a target over the limit.
bool begins_with_long_target(std::string_view line, const HttpLimits& limits);

/// The answer to a header that is not let in: what is over a limit, whom the door refuses (which is
/// counted), what the parser lets through and HTTP/1.1 does not, and encodings that nobody here
/// undoes.
std::optional<HttpResponse> check_header(const boost::beast::http::request_header<>& request,
                                         HttpCore& core);

}  // namespace anchord
