#include "api/http_checks.h"

#include <string>

namespace anchord {

namespace beast = boost::beast;
namespace http = beast::http;

namespace {

/// Room for the longest method before a target.
constexpr std::size_t kMethodBytes = 32;

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

std::optional<HttpResponse> ask_door(const http::request_header<>& request, HttpCore& core) {
  if (!core.door.refuse) return std::nullopt;
  const auto field = [&](http::field name) -> std::optional<std::string_view> {
    if (request.count(name) != 1) return std::nullopt;
    return view(request[name]);
  };
  HttpCaller caller{view(request.method_string()),     view(request.target()),
                    field(http::field::host),          field(http::field::origin),
                    field(http::field::authorization), field(http::field::sec_websocket_protocol)};
  if (request.count(http::field::origin) > 1) caller.origin = "null";  // nobody's
  auto refused = core.door.refuse(caller);
  if (refused) ++(refused->status == 401 ? core.counters.unauthorized : core.counters.foreign);
  return refused;
}

}  // namespace

HttpResponse refusal_of(boost::system::error_code error, const HttpLimits& limits) {
  if (error == http::error::header_limit)
    return http_error(
        431, "header_too_large",
        "the request's header may have " + std::to_string(limits.header_bytes) + " bytes",
        "header");
  if (error == http::error::body_limit)
    return http_error(413, "too_large",
                      "the request's body may have " + std::to_string(limits.body_bytes) + " bytes",
                      "body");
  return http_error(400, "malformed", "this is no HTTP/1.1 request: " + error.message());
}

HttpResponse target_too_long(const HttpLimits& limits) {
  return http_error(
      414, "target_too_long",
      "path and parameters may have " + std::to_string(limits.target_bytes) + " bytes", "target");
}

bool begins_with_long_target(std::string_view line, const HttpLimits& limits) {
  const auto space = line.substr(0, kMethodBytes).find(' ');
  if (space == std::string_view::npos) return false;
  const std::string_view target = line.substr(space + 1);
  return target.size() > limits.target_bytes && target.find(' ') == std::string_view::npos;
}

std::optional<HttpResponse> check_header(const http::request_header<>& request, HttpCore& core) {
  if (request.target().size() > core.limits.target_bytes) return target_too_long(core.limits);
  if (request.version() >= 11 && request.count(http::field::host) != 1)
    return http_error(400, "malformed", "the request must name its host once", "host");
  if (auto refused = ask_door(request, core)) return refused;
  const auto transfer = request[http::field::transfer_encoding];
  if (!transfer.empty() && !beast::iequals(transfer, "chunked"))
    return http_error(501, "unsupported", "a body may be chunked, and nothing else",
                      "transfer-encoding");
  const auto content = request[http::field::content_encoding];
  if (!content.empty() && !beast::iequals(content, "identity"))
    return http_error(415, "unsupported", "a body must not be compressed", "content-encoding");
  if (request.count(http::field::expect) > 0 &&
      !beast::iequals(request[http::field::expect], "100-continue"))
    return http_error(417, "unsupported", "only 100-continue can be expected", "expect");
  return std::nullopt;
}

}  // namespace anchord
