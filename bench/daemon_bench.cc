// The daemon with the plaza's frames coming in: how long its answers take. In this process, but
// with its real log on disk, real LCM and real HTTP.

#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "api/frame_json.h"
#include "bench/http_client.h"
#include "bench/live_daemon.h"
#include "bench/plaza_log.h"
#include "bench/timing.h"

namespace {

using Clock = std::chrono::steady_clock;
using anchord::bench::fail;
using anchord::bench::fixed;
using anchord::bench::LiveDaemon;
using anchord::bench::LiveRobot;
using anchord::bench::ms_since;
using anchord::bench::Times;

constexpr double kFramesPerSecond = 100;
void print(const std::string& what, const Times& times, const std::string& target) {
  anchord::bench::print_row({what, std::to_string(times.count()), fixed(times.median_ms(), 2),
                             fixed(times.p99_ms(), 2), fixed(times.max_ms(), 2), target});
}

/// Asks one question after the other while the frames come in.
void ask_while_frames_come(const std::vector<anchord::Frame>& frames) {
  const std::vector<std::string> questions = {"/v1/where?class=person",
                                              "/v1/where?class=person&color=red",
                                              "/v1/count?class=person&place=lawn"};
  LiveDaemon daemon(anchord::bench::read_knowledge(anchord::bench::kPlazaConfig));
  LiveRobot robot;
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
  robot.play(frames, kFramesPerSecond);
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
  LiveDaemon daemon(anchord::bench::read_knowledge(anchord::bench::kPlazaConfig));
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
