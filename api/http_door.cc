#include "api/http_door.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <memory>
#include <string>
#include <utility>

#include "api/stream.h"

namespace anchord {
namespace {

bool equal_without_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

/// Whether `origin` is that of a page which this server itself gave out under the name `host`.
bool is_own(std::string_view origin, std::string_view host) {
  for (const std::string_view scheme : {"http://", "https://"})
    if (origin.starts_with(scheme) && equal_without_case(origin.substr(scheme.size()), host))
      return true;
  return false;
}

HttpResponse unauthorized(bool has_one) {
  HttpResponse refusal = http_error(
      401, "unauthorized",
      has_one ? "this is not the token that the daemon was started with"
              : "send the token that the daemon was started with, as Authorization: Bearer TOKEN",
      "Authorization");
  refusal.headers.emplace_back(
      "WWW-Authenticate",
      has_one ? R"(Bearer realm="anchord", error="invalid_token")" : R"(Bearer realm="anchord")");
  return refusal;
}

}  // namespace

bool is_loopback_host(std::string_view host) {
  const auto bracket = host.rfind(']');
  const auto colon = host.rfind(':');
  if (colon != std::string_view::npos && (bracket == std::string_view::npos || bracket < colon)) {
    const auto port = host.substr(colon + 1);
    if (port.find_first_not_of("0123456789") != std::string_view::npos) return false;
    host = host.substr(0, colon);
  }
  if (equal_without_case(host, "localhost")) return true;
  boost::system::error_code error;
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    const std::string inside(host.substr(1, host.size() - 2));
    return boost::asio::ip::make_address_v6(inside, error).is_loopback() && !error;
  }
  return boost::asio::ip::make_address_v4(std::string(host), error).is_loopback() && !error;
}

HttpDoor loopback_door() {
  return {[](const HttpCaller& caller) -> std::optional<HttpResponse> {
            if (caller.host && !is_loopback_host(*caller.host))
              return http_error(421, "misdirected",
                                "without a token only this machine is served, under the names "
                                "localhost, 127.0.0.1 and [::1]",
                                "Host");
            if (caller.origin && !is_own(*caller.origin, caller.host.value_or("")))
              return http_error(403, "foreign_origin",
                                "pages of other origins are neither answered nor listened to",
                                "Origin");
            return std::nullopt;
          },
          false};
}

HttpDoor token_door(BearerToken token, std::function<bool(std::string_view)> is_public) {
  return {[token, is_public = std::move(is_public)](
              const HttpCaller& caller) -> std::optional<HttpResponse> {
            if (caller.authorization && token.admits(*caller.authorization)) return std::nullopt;
            const auto offered = caller.protocols ? offered_token(*caller.protocols) : std::nullopt;
            if (offered && token.admits("Bearer " + *offered)) return std::nullopt;
            if ((caller.method == "GET" || caller.method == "HEAD") && is_public(caller.target))
              return std::nullopt;
            return unauthorized(caller.authorization || offered);
          },
          true};
}

}  // namespace anchord
