// The daemon with the plaza's frames coming in: how long its answers take. In this process, but
// with its real log on disk, real LCM and real HTTP.

#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "anchord/world_t.hpp"
#include "api/frame_json.h"
#include "bench/http_client.h"
#include "bench/plaza_log.h"
#include "bench/timing.h"
#include "daemon/service.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"

namespace {

using Clock = std::chrono::steady_clock;
using anchord::bench::fixed;
using anchord::bench::Times;

constexpr double kFramesPerSecond = 100;
constexpr char kLcmUrl[] = "udpm://239.255.76.67:17699?ttl=0";

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

[[noreturn]] void fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::exit(EXIT_FAILURE);
}

/// A daemon with a log of its own, which goes when it goes.
class Daemon {
 public:
  Daemon() {
    std::string pattern = std::filesystem::temp_directory_path() / "anchord-bench-XXXXXX";
    if (!mkdtemp(pattern.data())) fail("no temporary directory can be made");
    options_.data_directory = directory_ = pattern;
    options_.lcm_url = kLcmUrl;
    options_.http_address = "127.0.0.1:" + std::to_string(port_);
    auto service = anchord::Service::open(
        anchord::bench::read_knowledge(anchord::bench::kPlazaConfig), options_);
    if (!service) fail(service.error().text());
    service_ = std::move(*service);
    const std::atomic<bool> cancelled{false};
    if (const auto started = service_->start(cancelled); !started) fail(started.error().text());
  }
  ~Daemon() {
    service_->stop();
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
  }
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  std::uint16_t port() const { return port_; }

 private:
  std::uint16_t port_ = anchord::bench::free_port();
  anchord::ServiceOptions options_;
  std::filesystem::path directory_;
  std::unique_ptr<anchord::Service> service_;
};

/// Publishes frames over LCM in a steady rhythm and hears what the daemon believes after each.
class Robot {
 public:
  Robot() {
    auto bus = anchord::LcmBus::open(kLcmUrl);
    if (!bus) fail(bus.error().text());
    bus_ = std::move(*bus);
    const auto heard = bus_->subscribe(
        anchord::kWorldChannel, [this](std::span<const std::uint8_t> bytes) { hear(bytes); });
    if (!heard) fail(heard.error().text());
    bus_->start();
  }

  void play(const std::vector<anchord::Frame>& frames) {
    const auto begin = Clock::now();
    for (std::size_t k = 0; k < frames.size(); ++k) {
      std::this_thread::sleep_until(
          begin + std::chrono::duration_cast<Clock::duration>(
                      std::chrono::duration<double>(static_cast<double>(k) / kFramesPerSecond)));
      const auto bytes = anchord::encode(frames[k], static_cast<std::int64_t>(k) + 1);
      {
        const std::lock_guard lock(mutex_);
        sent_[frames[k].utime] = Clock::now();
      }
      if (const auto out = bus_->publish(anchord::kDetectionsChannel, bytes); !out)
        fail(out.error().text());
    }
  }

  /// From the publishing of a frame to the coming of the world after it. After stop() only.
  const Times& world_latency() const { return latency_; }
  void stop() { bus_->stop(); }

 private:
  void hear(std::span<const std::uint8_t> bytes) {
    anchord::world_t world;
    if (world.decode(bytes.data(), 0, static_cast<int>(bytes.size())) < 0) return;
    const std::lock_guard lock(mutex_);
    if (const auto sent = sent_.find(world.utime); sent != sent_.end())
      latency_.add(ms_since(sent->second));
  }

  std::mutex mutex_;
  std::map<anchord::Utime, Clock::time_point> sent_;
  Times latency_;
  std::unique_ptr<anchord::LcmBus> bus_;  // ends before what its thread uses
};

void print(const std::string& what, const Times& times, const std::string& target) {
  anchord::bench::print_row({what, std::to_string(times.count()), fixed(times.median_ms(), 2),
                             fixed(times.p99_ms(), 2), fixed(times.max_ms(), 2), target});
}

/// Asks one question after the other while the frames come in.
void ask_while_frames_come(const std::vector<anchord::Frame>& frames) {
  const std::vector<std::string> questions = {"/v1/where?class=person",
                                              "/v1/where?class=person&color=red",
                                              "/v1/count?class=person&place=lawn"};
  Daemon daemon;
  Robot robot;
  std::vector<Times> times(questions.size());
  std::atomic<bool> playing{true};
  std::thread asker([&] {
    anchord::bench::HttpClient client(daemon.port());
    for (std::size_t i = 0; playing; ++i) {
      const auto begin = Clock::now();
      if (const int status = client.get(questions[i % questions.size()]); status != 200)
        fail("answered with status " + std::to_string(status));
      times[i % questions.size()].add(ms_since(begin));
    }
  });
  robot.play(frames);
  playing = false;
  asker.join();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // the last worlds are on their way
  robot.stop();
  for (std::size_t i = 0; i < questions.size(); ++i)
    print("GET " + questions[i], times[i],
          questions[i].starts_with("/v1/where") ? "p99 < 5 ms" : "");
  print("LCM frame to ANCHORD_WORLD, asked meanwhile", robot.world_latency(), "");
}

void post_one_after_the_other(const std::vector<anchord::Frame>& frames) {
  constexpr std::size_t kMost = 200;
  Daemon daemon;
  anchord::bench::HttpClient client(daemon.port());
  Times times;
  for (std::size_t k = 0; k < frames.size() && k < kMost; ++k) {
    const std::string body = anchord::to_json(frames[k]).dump();
    const auto begin = Clock::now();
    if (const int status = client.post("/v1/detections", body); status != 200)
      fail("answered with status " + std::to_string(status));
    times.add(ms_since(begin));
  }
  print("POST /v1/detections, until durable", times, "");
}

}  // namespace

int main() {
  spdlog::set_level(spdlog::level::warn);
  const auto frames = anchord::bench::read_log(anchord::bench::kPlazaLog);
  std::printf("%zu frames of %s over LCM, %g a second; one client asks without a pause\n\n",
              frames.size(), anchord::bench::kPlazaLog, kFramesPerSecond);
  anchord::bench::print_head({"what", "times", "p50 ms", "p99 ms", "max ms", "target"});
  ask_while_frames_come(frames);
  post_one_after_the_other(frames);
  return EXIT_SUCCESS;
}
