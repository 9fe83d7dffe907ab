// anchor-play: plays the frames of an LCM log over LCM, in the rhythm in which they were recorded.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

#include "api/lcm_bus.h"
#include "api/lcm_log.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"

namespace {

int fail(const std::string& message) {
  std::fprintf(stderr, "anchor-play: %s\n", message.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Plays the frames of an LCM log over LCM, in the rhythm of their time stamps."};
  std::string file, url;
  double speed = 1;
  app.add_option("file", file, "LCM log")->required();
  app.add_option("--lcm", url, "LCM URL; default: LCM's own with ttl 0");
  app.add_option("--speed", speed, "times real time; 0: as fast as it goes")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }

  std::ifstream stream(file, std::ios::binary);
  if (!stream) return fail(file + " cannot be read");
  anchord::LcmLogReader log(stream);
  auto bus = anchord::LcmBus::open(url);
  if (!bus) return fail(bus.error().text());

  const auto begin = std::chrono::steady_clock::now();
  anchord::Utime first = 0;
  std::int64_t seq = 0;
  while (true) {
    const auto message = log.next_frame();
    if (!message) return fail(file + ": " + message.error().text());
    if (!*message) break;
    const anchord::Frame& frame = (**message).frame;
    if (seq == 0) first = frame.utime;
    if (speed > 0)
      std::this_thread::sleep_until(
          begin +
          std::chrono::duration_cast<std::chrono::steady_clock::duration>(
              std::chrono::duration<double>(anchord::seconds_between(first, frame.utime) / speed)));
    const auto sent = (*bus)->publish(anchord::kDetectionsChannel, anchord::encode(frame, ++seq));
    if (!sent) return fail(sent.error().text());
  }
  std::printf("played %lld frames\n", static_cast<long long>(seq));
  return 0;
}
