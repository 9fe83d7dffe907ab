#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "api/scene_source.h"
#include "core/result.h"
#include "daemon/archive.h"
#include "daemon/http_front.h"
#include "daemon/journal.h"
#include "daemon/lcm_front.h"
#include "daemon/robots.h"
#include "daemon/status.h"
#include "daemon/verifications.h"

namespace anchord {

struct ServiceOptions {
  std::string data_directory = "anchord-data";
  std::string lcm_url;  ///< empty: LCM's own default with ttl 0
  std::string http_address = "127.0.0.1:7780";
  std::string token_file;            ///< empty: no token, and loopback addresses only
  std::string viewer;                ///< folder of the pages that are served; empty: none
  double checkpoint_interval = 0.5;  ///< s of work on frames between checkpoints
  /// The program that receives LCM for this one: its main() calls receive_lcm(). Itself, so that
  /// the two are of one version though another was installed meanwhile.
  std::string lcm_receiver = "/proc/self/exe";
};

/// The daemon: owns the journal and its fronts, in the order in which they depend on each other.
class Service {
 public:
  /// Takes the log, the port and the LCM network, or says what is in the way; nothing is served
  /// or received yet but 503.
  /// From a thread that lives as long as the service: the process that receives LCM ends with it.
  static Result<std::unique_ptr<Service>> open(Knowledge knowledge, const ServiceOptions& options);
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Restores the belief from the log, then begins to receive. Tells systemd. `cancelled` may turn
  /// true at any time.
  Status start(const std::atomic<bool>& cancelled);

  /// Receives no more, finishes what has begun as far as that goes in a second, commits.
  void stop();

 private:
  Service(Knowledge knowledge, const ServiceOptions& options, std::unique_ptr<FrameLog> log,
          std::unique_ptr<LcmSender> sender, std::unique_ptr<LcmReceiver> receiver,
          std::shared_ptr<const StaticFiles> viewer);
  HttpBackend backend();
  /// The belief or a task has changed: those who watch are told.
  void show();
  StatusSources sources() const;

  ServiceOptions options_;
  double began_;
  std::shared_ptr<const StaticFiles> viewer_;
  std::atomic<bool> ready_{false};
  Statistics statistics_;
  UpdateTimes times_;
  std::unique_ptr<LcmFront> lcm_;
  Robots robots_;
  std::unique_ptr<Journal> journal_;
  std::unique_ptr<Archive> archive_;
  std::unique_ptr<Verifications> verifications_;
  std::unique_ptr<SceneSource> scenes_;
  std::unique_ptr<HttpServer> http_;
  std::atomic<HttpServer*> listening_{nullptr};  ///< http_, for those whom it serves
};

}  // namespace anchord
