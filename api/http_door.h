#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "api/bearer_token.h"
#include "api/http_message.h"

namespace anchord {

/// What a request's header says of where it comes from, as sent; for as long as the call.
struct HttpCaller {
  std::string_view method, target;
  std::optional<std::string_view> host;           ///< missing only where HTTP/1.0 allows that
  std::optional<std::string_view> origin;         ///< browsers send it, others do not
  std::optional<std::string_view> authorization;  ///< missing also where it was sent twice
  std::optional<std::string_view> protocols;      ///< Sec-WebSocket-Protocol; see kTokenProtocol
};

/// Who is let in, asked before a request's body is read.
struct HttpDoor {
  /// The answer to who is not let in; nothing to who is. Empty: everybody is. Called on the
  /// server's threads, for several requests at a time.
  std::function<std::optional<HttpResponse>(const HttpCaller&)> refuse;
  /// Whether it may be served on anything but a loopback address.
  bool beyond_loopback = false;
};

/// A door for a machine's own programs, on loopback. A web page that somebody on the machine has
/// open can reach loopback too, so what a browser says is held against it: 421 where the host is
/// neither `localhost` nor a loopback address, as after a name was bound to one (DNS rebinding);
/// 403 for a page of another origin. Any port will do: behind a tunnel it is another one.
HttpDoor loopback_door();

/// A door that asks for a token, as Authorization or as a WebSocket's subprotocol: 401 without it.
/// `is_public` says of which GET targets anybody may have the answer. Hosts and origins do not
/// matter then: no page of another origin has the token, nor may it send that field here, since no
/// answer allows it to (CORS).
HttpDoor token_door(BearerToken token, std::function<bool(std::string_view target)> is_public);

/// Whether a Host field's value, with a port or without, means this machine: `localhost`, what is
/// in 127.0.0.0/8, `[::1]`.
bool is_loopback_host(std::string_view host);

}  // namespace anchord
