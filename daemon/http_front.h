#pragma once

#include <functional>

#include "api/http_server.h"
#include "daemon/journal.h"

namespace anchord {

/// What the daemon says of itself.
struct SelfDescription {
  std::function<HttpResponse()> status, metrics;
};

/// Routes requests: POST /v1/detections to the journal, questions to a snapshot, status, metrics
/// and the API's description. Until `ready` questions and frames get 503.
HttpHandler http_routes(Journal& journal, const std::atomic<bool>& ready, Statistics& statistics,
                        SelfDescription self);

/// Answers a GET of the belief or of the daemon itself; for HTTP and LCM alike.
HttpResponse answer_get(const HttpTarget& target, const Journal& journal,
                        const std::atomic<bool>& ready, const SelfDescription& self);

}  // namespace anchord
