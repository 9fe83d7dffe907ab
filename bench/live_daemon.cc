#include "bench/live_daemon.h"

#include <unistd.h>

#include <anchord/world_t.hpp>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "bench/http_client.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "lcmtypes/verification_codec.h"

namespace anchord::bench {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

void fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::exit(EXIT_FAILURE);
}

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

LiveDaemon::LiveDaemon(Knowledge knowledge) : port_(free_port()) {
  std::string pattern = std::filesystem::temp_directory_path() / "anchord-bench-XXXXXX";
  if (!mkdtemp(pattern.data())) fail("no temporary directory can be made");
  options_.data_directory = directory_ = pattern;
  options_.lcm_url = kLcmUrl;
  options_.http_address = "127.0.0.1:" + std::to_string(port_);
  options_.lcm_receiver = ANCHORD;
  auto service = Service::open(std::move(knowledge), options_);
  if (!service) fail(service.error().text());
  service_ = std::move(*service);
  const std::atomic<bool> cancelled{false};
  if (const auto started = service_->start(cancelled); !started) fail(started.error().text());
}

LiveDaemon::~LiveDaemon() {
  service_->stop();
  std::error_code ignored;
  std::filesystem::remove_all(directory_, ignored);
}

LiveRobot::LiveRobot() {
  auto bus = LcmBus::open(kLcmUrl);
  if (!bus) fail(bus.error().text());
  bus_ = std::move(*bus);
  const auto heard =
      bus_->subscribe(kWorldChannel, [this](std::span<const std::uint8_t> bytes) { hear(bytes); });
  if (!heard) fail(heard.error().text());
  bus_->start();
}

void LiveRobot::play(const std::vector<Frame>& frames, double frames_per_second) {
  const auto begin = Clock::now();
  for (std::size_t k = 0; k < frames.size(); ++k) {
    std::this_thread::sleep_until(
        begin + std::chrono::duration_cast<Clock::duration>(
                    std::chrono::duration<double>(static_cast<double>(k) / frames_per_second)));
    const auto bytes = encode(frames[k], static_cast<std::int64_t>(k) + 1);
    {
      const std::lock_guard lock(mutex_);
      sent_[frames[k].utime] = Clock::now();
    }
    if (const auto out = bus_->publish(kDetectionsChannel, bytes); !out) fail(out.error().text());
  }
}

void LiveRobot::tell(const RobotPose& pose) {
  if (const auto out = bus_->publish(kPoseChannel, encode(pose)); !out) fail(out.error().text());
}

void LiveRobot::hear(std::span<const std::uint8_t> bytes) {
  world_t world;
  if (world.decode(bytes.data(), 0, static_cast<int>(bytes.size())) < 0) return;
  const std::lock_guard lock(mutex_);
  if (const auto sent = sent_.find(world.utime); sent != sent_.end())
    latency_.add(ms_since(sent->second));
}

}  // namespace anchord::bench
