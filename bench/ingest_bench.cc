// How many frames a second of 10 detections, of 20 objects, the daemon takes over LCM: what is lost
// where, and how long answers take meanwhile.

#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "api/lcm_sender.h"
#include "bench/hall.h"
#include "bench/http_client.h"
#include "bench/live_daemon.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"

namespace {

using anchord::bench::fail;
using anchord::bench::fixed;
using anchord::bench::HttpClient;
using anchord::bench::ms_since;
using Clock = std::chrono::steady_clock;
using nlohmann::json;

constexpr double kSeconds = 5;

json status(HttpClient& client) {
  if (client.get("/v1/status") != 200) fail("no status");
  return json::parse(client.body());
}

void run(double cell, double frames_per_second) {
  std::vector<std::vector<std::uint8_t>> messages;
  for (const auto& frame : anchord::bench::hall_frames(
           static_cast<int>(kSeconds * frames_per_second), frames_per_second))
    messages.push_back(anchord::encode(frame, static_cast<std::int64_t>(messages.size()) + 1));
  anchord::bench::LiveDaemon daemon(anchord::bench::hall(cell));
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
  for (std::size_t k = 0; k < messages.size(); ++k) {
    std::this_thread::sleep_until(
        begin + std::chrono::duration_cast<Clock::duration>(
                    std::chrono::duration<double>(static_cast<double>(k) / frames_per_second)));
    if (const auto out = (*sender)->publish(anchord::kDetectionsChannel, messages[k]); !out)
      fail(out.error().text());
  }
  const double rate = 1000 * static_cast<double>(messages.size()) / ms_since(begin);
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
  std::printf("frames of 10 detections of 20 objects over LCM for %g s\n\n", kSeconds);
  anchord::bench::print_head({"cell m", "frames/s", "accepted", "lost", "dropped", "by the kernel",
                              "overrun", "waiting at the end", "update us", "GET p99 ms"});
  for (const double cell : {0.25, 1.0})
    for (const double rate : {1000, 2000, 3000, 5000}) run(cell, rate);
  return EXIT_SUCCESS;
}
