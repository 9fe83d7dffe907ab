// How many frames a second of 10 detections, of 20 objects, the daemon takes over LCM: what is lost
// where, and how long answers take meanwhile.

#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "api/lcm_sender.h"
#include "bench/http_client.h"
#include "bench/live_daemon.h"
#include "knowledge/configuration.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"

namespace {

using anchord::bench::fail;
using anchord::bench::fixed;
using anchord::bench::HttpClient;
using anchord::bench::ms_since;
using Clock = std::chrono::steady_clock;
using nlohmann::json;

constexpr int kSeenAtOnce = 10;
constexpr double kSeconds = 5, kHalf = 10;
constexpr anchord::Utime kStart = 1'700'000'000'000'000;

/// A hall of 20 x 10 m; `cell` (m): of the grid of what has not been detected.
anchord::Knowledge knowledge(double cell) {
  json scene;
  scene["world"] = {{"dimensions", 2},
                    {"bounds", {{"min", {0, 0}}, {"max", {2 * kHalf, kHalf}}}},
                    {"cell", cell}};
  scene["classes"]["default"] = {
      {"models", {{{"kind", "constant_position"}, {"position_psd", 1e-4}}}},
      {"detection_probability", 0.95}};
  scene["sensors"]["default"] = {{"clutter_density", 1e-4}};
  const auto configuration = anchord::parse_configuration(scene.dump());
  if (!configuration.ok()) fail(configuration.mistakes().front().text());
  return configuration.knowledge();
}

/// Each frame sees one half of the hall, in turn, with its ten objects 2 m apart.
std::vector<std::vector<std::uint8_t>> messages(double frames_per_second) {
  std::vector<std::vector<std::uint8_t>> out;
  const int count = static_cast<int>(kSeconds * frames_per_second);
  for (int k = 0; k < count; ++k) {
    anchord::Frame frame;
    frame.utime = kStart + static_cast<anchord::Utime>(k * 1e6 / frames_per_second);
    frame.sensor = "camera";
    const double left = k % 2 * kHalf;
    frame.view.emplace().type = anchord::View::Type::kPolygon;
    frame.view->points = {{left, 0}, {left + kHalf, 0}, {left + kHalf, kHalf}, {left, kHalf}};
    for (int i = 0; i < kSeenAtOnce; ++i) {
      const double x = left + 1 + 2 * (i % 5) + 0.02 * std::sin(k + i),
                   y = 3 + 4 * (i / 5) + 0.02 * std::cos(k + 2 * i);
      frame.detections.emplace_back().measurement =
          anchord::CartesianMeasurement{{x, y}, {1e-3, 0, 0, 1e-3}};
    }
    out.push_back(anchord::encode(frame, k + 1));
  }
  return out;
}

json status(HttpClient& client) {
  if (client.get("/v1/status") != 200) fail("no status");
  return json::parse(client.body());
}

void run(double cell, double frames_per_second) {
  const auto frames = messages(frames_per_second);
  anchord::bench::LiveDaemon daemon(knowledge(cell));
  const auto sender = anchord::LcmSender::open(anchord::bench::kLcmUrl);
  if (!sender) fail(sender.error().text());
  HttpClient client(daemon.port());
  anchord::bench::Times asked;
  std::atomic<bool> playing{true};
  std::thread asker([&] {
    HttpClient other(daemon.port());
    while (playing) {
      const auto begin = Clock::now();
      if (other.get("/v1/objects") != 200) fail("no answer");
      asked.add(ms_since(begin));
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  });
  const auto begin = Clock::now();
  for (std::size_t k = 0; k < frames.size(); ++k) {
    std::this_thread::sleep_until(
        begin + std::chrono::duration_cast<Clock::duration>(
                    std::chrono::duration<double>(static_cast<double>(k) / frames_per_second)));
    if (const auto out = (*sender)->publish(anchord::kDetectionsChannel, frames[k]); !out)
      fail(out.error().text());
  }
  const double rate = 1000 * static_cast<double>(frames.size()) / ms_since(begin);
  playing = false;
  asker.join();
  const auto waited = status(client)["queue"];
  json before, now = status(client)["frames"];
  do {  // until nothing comes of it any more
    before = now;
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    now = status(client)["frames"];
  } while (now != before);
  const auto lcm = status(client)["lcm"];
  const auto number = [](const json& value) { return std::to_string(value.get<long>()); };
  anchord::bench::print_row(
      {fixed(cell, 2), fixed(rate, 0), number(now["accepted"]), number(now["lost"]),
       number(lcm["dropped"]), number(lcm["dropped_by_kernel"]), number(now["overrun"]),
       number(waited["frames"]), fixed(status(client)["update_us"]["median"].get<double>(), 0),
       fixed(asked.p99_ms(), 1)});
}

}  // namespace

int main() {
  spdlog::set_level(spdlog::level::err);
  std::printf("frames of %d detections of %d objects over LCM for %g s\n\n", kSeenAtOnce,
              2 * kSeenAtOnce, kSeconds);
  anchord::bench::print_head({"cell m", "frames/s", "accepted", "lost", "dropped", "by the kernel",
                              "overrun", "waiting at the end", "update us", "GET p99 ms"});
  for (const double cell : {0.25, 1.0})
    for (const double rate : {1000, 2000, 3000, 5000}) run(cell, rate);
  return EXIT_SUCCESS;
}
