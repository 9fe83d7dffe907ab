// How many frames a second of 10 detections, of 20 objects, the daemon takes over HTTP from one
// client that posts batches, each acknowledged once all of it is on disk.

#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "api/frame_json.h"
#include "bench/hall.h"
#include "bench/http_client.h"
#include "bench/live_daemon.h"

namespace {

using anchord::bench::fail;
using anchord::bench::fixed;
using anchord::bench::ms_since;
using Clock = std::chrono::steady_clock;

constexpr int kFrames = 10'000;
constexpr double kFramesPerSecond = 1000;  // by their own time

void run(double cell, int batch) {
  std::vector<std::string> bodies;
  auto frames = nlohmann::json::array();
  for (const auto& frame : anchord::bench::hall_frames(kFrames, kFramesPerSecond)) {
    frames.push_back(anchord::to_json(frame));
    if (static_cast<int>(frames.size()) < batch) continue;
    bodies.push_back(frames.dump());
    frames.clear();
  }
  anchord::bench::LiveDaemon daemon(anchord::bench::hall(cell));
  anchord::bench::HttpClient client(daemon.port());
  anchord::bench::Times acknowledged;
  const auto begin = Clock::now();
  for (const std::string& body : bodies) {
    const auto posted = Clock::now();
    if (client.post("/v1/detections", body) != 200) fail(client.body());
    acknowledged.add(ms_since(posted));
  }
  const double rate = 1000 * kFrames / ms_since(begin);
  if (client.get("/v1/status") != 200) fail("no status");
  const auto accepted = nlohmann::json::parse(client.body())["frames"]["accepted"].get<int>();
  if (accepted != kFrames) fail("accepted " + std::to_string(accepted));
  anchord::bench::print_row({fixed(cell, 2), std::to_string(batch), fixed(rate, 0),
                             fixed(acknowledged.median_ms(), 2), fixed(acknowledged.p99_ms(), 2),
                             batch == 10 ? "2000 frames/s" : ""});
}

}  // namespace

int main() {
  spdlog::set_level(spdlog::level::err);
  std::printf("%d frames of 10 detections of 20 objects over HTTP, durable\n\n", kFrames);
  anchord::bench::print_head({"cell m", "batch", "frames/s", "p50 ms", "p99 ms", "target"});
  for (const double cell : {0.25, 1.0})
    for (const int batch : {1, 10, 100}) run(cell, batch);
  return EXIT_SUCCESS;
}
