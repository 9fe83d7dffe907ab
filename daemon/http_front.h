#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>

#include "api/http_server.h"
#include "api/static_files.h"
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
  std::shared_ptr<const StaticFiles> viewer;  ///< pages for people; perhaps none
};

/// Routes requests: frames and events to the journal, triggers and results to the verifications,
/// questions to a snapshot, status, metrics and the API's description; other paths may be pages.
HttpHandler http_routes(HttpBackend backend);

/// Answers a GET of the belief, of what it was, or of the daemon itself; for HTTP and LCM alike.
/// What needs the log is answered from another thread.
void answer_get(HttpTarget target, const HttpBackend& backend, const HttpReply& reply);

/// With a token everything needs it but the viewer's pages, which hold nothing of the belief and
/// cannot be given one by a browser that opens them; without one, loopback_door().
HttpDoor front_door(std::optional<BearerToken> token, std::shared_ptr<const StaticFiles> viewer);

}  // namespace anchord
