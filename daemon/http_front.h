#pragma once

#include <atomic>
#include <functional>

#include "api/http_server.h"
#include "daemon/archive.h"
#include "daemon/journal.h"
#include "daemon/robots.h"
#include "daemon/statistics.h"
#include "daemon/verifications.h"

namespace anchord {

/// What the daemon says of itself.
struct SelfDescription {
  std::function<HttpResponse()> status, metrics;
};

/// Told of a body that is no frame or array of frames, on a thread of the server.
using RefusedBody = std::function<void(const Error&)>;

/// Where frames that come over HTTP are said to come from.
inline constexpr char kHttpOrigin[] = "HTTP";

/// What requests are handed to.
struct HttpBackend {
  Journal& journal;
  Archive& archive;
  Verifications& verifications;
  Robots& robots;
  const std::atomic<bool>& ready;  ///< until then what needs the belief gets 503
  Statistics& statistics;
  SelfDescription self;
  RefusedBody refused;
};

/// Routes requests: frames and events to the journal, triggers and results to the verifications,
/// questions to a snapshot, status, metrics and the API's description.
HttpHandler http_routes(HttpBackend backend);

/// Answers a GET of the belief, of what it was, or of the daemon itself; for HTTP and LCM alike.
/// What needs the log is answered from another thread.
void answer_get(HttpTarget target, const HttpBackend& backend, const HttpReply& reply);

}  // namespace anchord
