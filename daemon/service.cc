#include "daemon/service.h"

#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>

#include <chrono>
#include <future>
#include <optional>
#include <utility>

#include "api/scene_streams.h"

namespace anchord {
namespace {

constexpr std::chrono::milliseconds kDrain{500};  // for requests that have begun

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Result<std::unique_ptr<Service>> Service::open(Knowledge knowledge, const ServiceOptions& options) {
  auto viewer = options.viewer.empty() ? StaticFiles() : StaticFiles::read(options.viewer);
  if (!viewer) return viewer.error();
  std::optional<BearerToken> token;
  if (!options.token_file.empty()) {
    auto read = BearerToken::read(options.token_file);
    if (!read) return read.error();
    token = *std::move(read);
  }
  auto log = FrameLog::open(options.data_directory);
  if (!log) return log.error();
  auto sender = LcmSender::open(options.lcm_url);
  if (!sender) return sender.error();
  auto receiver = LcmReceiver::open(options.lcm_receiver, (*sender)->url());
  if (!receiver) return receiver.error();
  const std::string frame = knowledge.map_frame;
  std::unique_ptr<Service> service(new Service(std::move(knowledge), options, *std::move(log),
                                               *std::move(sender), *std::move(receiver),
                                               std::make_shared<StaticFiles>(*std::move(viewer))));
  auto http = HttpServer::start(options.http_address, http_routes(service->backend()), {},
                                front_door(std::move(token), service->viewer_),
                                scene_streams(*service->scenes_, frame, service->ready_));
  if (!http) return http.error();
  service->http_ = std::move(*http);
  service->listening_ = service->http_.get();
  return service;
}

Service::Service(Knowledge knowledge, const ServiceOptions& options, std::unique_ptr<FrameLog> log,
                 std::unique_ptr<LcmSender> sender, std::unique_ptr<LcmReceiver> receiver,
                 std::shared_ptr<const StaticFiles> viewer)
    : options_(options), began_(seconds()), viewer_(std::move(viewer)) {
  lcm_ = std::make_unique<LcmFront>(std::move(sender), std::move(receiver), statistics_);
  World world(std::move(knowledge));
  Journal::Hooks hooks;
  hooks.applied = [this, background = world.background()](std::shared_ptr<const Belief> belief) {
    lcm_->publish_world(std::move(belief), background);
    show();
  };
  hooks.refused = [this](const Submission& submission, const Frame* frame, const Error& why) {
    if (submission.origin != kHttpOrigin) ++statistics_.refused_lcm;
    lcm_->publish_refusal(submission.origin, frame, why);
  };
  hooks.alive = [this, last = 0.0]() mutable {
    if (seconds() - last < 0.5) return;
    last = seconds();
    // While a long history is restored the start may take as long as it goes on.
    sd_notify(0, ready_ ? "WATCHDOG=1" : "WATCHDOG=1\nEXTEND_TIMEOUT_USEC=60000000");
  };
  const World empty = world;
  auto checkpointer =
      std::make_unique<Checkpointer>(options.data_directory, empty, options.checkpoint_interval);
  journal_ = std::make_unique<Journal>(std::move(world), std::move(log), statistics_, times_,
                                       std::move(hooks), std::move(checkpointer));
  archive_ = std::make_unique<Archive>(*journal_, options.data_directory, empty);
  verifications_ =
      std::make_unique<Verifications>(*journal_, robots_, [this](const Task& task, Utime now) {
        lcm_->publish_task(task, now);
        show();
      });
  scenes_ = std::make_unique<SceneSource>([this] {
    return std::pair(journal_->snapshot(), SceneParts{verifications_->open_tasks(), robots_.all()});
  });
}

Service::~Service() { stop(); }

Status Service::start(const std::atomic<bool>& cancelled) {
  const double begin = seconds();
  if (Status restored = journal_->restore(cancelled); !restored) return restored;
  if (cancelled) return Done{};
  if (journal_->logged_frames() > 0)
    spdlog::info("restored the belief from {} frames, {} of them by a checkpoint, in {:.1f} s",
                 journal_->logged_frames(), journal_->resumed_frames(), seconds() - begin);
  if (Status taken_up = verifications_->restore(); !taken_up) return taken_up;
  const auto answerer = [backend = backend()](const HttpTarget& target) {
    std::promise<HttpResponse> answered;
    answer_get(target, backend, [&](HttpResponse response) { answered.set_value(response); });
    return answered.get_future().get();
  };
  lcm_->start(*journal_, *verifications_, robots_, answerer);
  journal_->start();
  verifications_->start();
  ready_ = true;
  sd_notify(0, "READY=1");
  spdlog::info("ready: http://{} and LCM {}", sources().http_address, lcm_->url());
  return Done{};
}

void Service::stop() {
  if (!journal_) return;
  sd_notify(0, "STOPPING=1");
  ready_ = false;
  lcm_->stop();
  if (http_) http_->stop(kDrain);
  listening_ = nullptr;
  verifications_->stop();
  archive_->stop();
  journal_.reset();  // applies and commits what waits
  lcm_.reset();      // after it has published what came of that
  http_.reset();     // which show() still wakes until then
}

void Service::show() {
  if (!scenes_) return;
  scenes_->changed();
  if (HttpServer* http = listening_) http->wake_streams();
}

HttpBackend Service::backend() {
  return {
      *journal_,
      *archive_,
      *verifications_,
      robots_,
      ready_,
      statistics_,
      {[this] { return status_answer(sources()); }, [this] { return metrics_answer(sources()); }},
      [&lcm = *lcm_](const Error& why) { lcm.publish_refusal(kHttpOrigin, nullptr, why); },
      viewer_};
}

StatusSources Service::sources() const {
  std::string address = options_.http_address;
  const HttpServer* http = listening_;
  if (http) address = address.substr(0, address.rfind(':') + 1) + std::to_string(http->port());
  return {statistics_,
          times_,
          *journal_,
          *verifications_,
          http,
          lcm_->received(),
          options_.data_directory,
          lcm_->url(),
          address,
          ready_,
          seconds() - began_};
}

}  // namespace anchord
