#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/http_message.h"
#include "core/result.h"

namespace anchord {

/// What one client of a WebSocket is told, and says. It is asked for the next message when the last
/// one has gone out, so that nothing is ever queued for a client that reads slowly. Called on the
/// server's threads, one call at a time.
class StreamClient {
 public:
  struct Message {
    std::shared_ptr<const std::string> bytes;
    bool binary = false;  ///< else text
  };
  virtual ~StreamClient() = default;
  /// What to say now; nothing: there is nothing new, and it is asked again after wake_streams().
  virtual std::optional<Message> next() = 0;
  /// How long to say nothing after the message that next() has just given.
  virtual std::chrono::milliseconds pause() const = 0;
  /// Hears a text message. An error ends the connection, with the error as its reason.
  virtual Status hear(std::string_view text) = 0;
};

/// A client that is let in, and which of the subprotocols it offered is spoken; none: empty.
struct StreamOpening {
  std::unique_ptr<StreamClient> client;
  std::string protocol;
};

/// Opens a stream for who asks for one, or says why not. Called on the server's threads.
using StreamOpener = std::function<Result<StreamOpening>(
    const HttpTarget& target, const std::vector<std::string>& protocols)>;

/// The subprotocols in a Sec-WebSocket-Protocol field, in order.
std::vector<std::string> offered_protocols(std::string_view field);

/// With this before it, an offered subprotocol is the token of who asks: base64url without padding,
/// since a browser can set no Authorization field on a WebSocket. It is never the one spoken.
inline constexpr std::string_view kTokenProtocol = "anchord.token.";

/// The token in what is offered, if there is one.
std::optional<std::string> offered_token(std::string_view field);

}  // namespace anchord
