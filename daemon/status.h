#pragma once

#include <string>

#include "api/http_server.h"
#include "daemon/journal.h"
#include "daemon/lcm_receiver.h"
#include "daemon/statistics.h"
#include "daemon/verifications.h"

namespace anchord {

/// What status and metrics are told from.
struct StatusSources {
  const Statistics& statistics;
  const UpdateTimes& times;
  const Journal& journal;
  const Verifications& verifications;
  const HttpServer* http;  ///< null while it does not listen yet
  const LcmReceiver::Counters& lcm;
  std::string data_directory, lcm_url, http_address;
  bool ready;
  double uptime_s;
};

/// GET /v1/status.
HttpResponse status_answer(const StatusSources& sources);

/// GET /metrics: Prometheus' text format 0.0.4.
HttpResponse metrics_answer(const StatusSources& sources);

}  // namespace anchord
