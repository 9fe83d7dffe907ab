#pragma once

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <memory>

#include "api/http_core.h"
#include "api/stream.h"

namespace anchord {

using UpgradeRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// Whether a request asks for a WebSocket.
bool wants_stream(const UpgradeRequest& request);

/// Goes on with a connection whose request has been granted; the socket's executor is its strand.
std::shared_ptr<HttpSession> make_websocket_session(HttpCore& core, HttpCore::tcp::socket socket,
                                                    UpgradeRequest request, StreamOpening opening);

}  // namespace anchord
