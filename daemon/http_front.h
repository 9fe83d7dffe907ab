#pragma once

#include <atomic>
#include <functional>

#include "api/http_server.h"
#include "daemon/journal.h"

namespace anchord {

/// What the daemon says of itself.
struct SelfDescription {
  std::function<HttpResponse()> status, metrics;
};

/// Told of a body that is no frame or array of frames, on a thread of the server.
using RefusedBody = std::function<void(const Error&)>;

/// Where frames that come over HTTP are said to come from.
inline constexpr char kHttpOrigin[] = "HTTP";

/// Routes requests: POST /v1/detections to the journal, questions to a snapshot, status, metrics
/// and the API's description. Unless `ready` questions and frames get 503.
HttpHandler http_routes(Journal& journal, const std::atomic<bool>& ready, Statistics& statistics,
                        SelfDescription self, RefusedBody refused);

/// Answers a GET of the belief or of the daemon itself; for HTTP and LCM alike.
HttpResponse answer_get(const HttpTarget& target, const Journal& journal,
                        const std::atomic<bool>& ready, const SelfDescription& self);

}  // namespace anchord
