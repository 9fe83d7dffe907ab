#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.h"

namespace anchord {

/// What a request asks for, percent-decoded: `/v1/where?class=cup&color=light+blue`.
struct HttpTarget {
  std::string path;  ///< begins with '/', or is "*" (OPTIONS)
  /// In the order in which they came; a name may come twice, and a value may be empty.
  std::vector<std::pair<std::string, std::string>> parameters;
  bool operator==(const HttpTarget&) const = default;
};

/// Reads a request target. In parameters '+' is a space. An absolute one (`http://host/path`) loses
/// its host. Refused: one that does not begin with '/', a '%' without two hexadecimal digits after
/// it, and what decodes to control characters or to no UTF-8.
Result<HttpTarget> parse_target(std::string_view target);

struct HttpRequest {
  std::string method;  ///< as sent: "GET", "POST"; for HEAD "GET", whose body is not sent then
  HttpTarget target;
  std::string content_type;  ///< as sent, with its parameters; empty if missing
  std::string body;
  std::string if_none_match = {};  ///< that field, as sent
};

struct HttpResponse {
  int status = 200;  ///< 200 to 599
  std::string content_type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;  ///< beside those of the transport
};

/// `{"error":{"code":...,"message":...,"field":...}}`, without the field if it is empty.
HttpResponse http_error(int status, std::string_view code, std::string_view message,
                        std::string_view field = {});
/// The same for a refusal of the engine or the store: kInvalid 400, kUnknown 404, kConflict 409,
/// kTooLarge 413, kUnavailable 503, kIo 500, kStorage 507.
HttpResponse http_error(const Error& error);

/// Answers a request. It may be called from any thread, at any time, also after the server has
/// gone; a second answer is ignored. If every copy goes without an answer, the client gets 500.
using HttpReply = std::function<void(HttpResponse)>;
/// Called on the server's threads, for several requests at a time: what takes long answers later,
/// from another thread.
using HttpHandler = std::function<void(HttpRequest, HttpReply reply)>;

}  // namespace anchord
