// A long log: what it takes on the disk, how fast a daemon starts on it after a kill, and how fast
// it answers what was believed at any time of it.
//
//     long_log_bench [FRAMES [DIR]]
//
// Makes a log of FRAMES frames (100,000), ten a second of a still camera that sees three of a
// home's objects move now and then, in DIR (a folder that goes at the end); one that is there
// already is taken as it is.

#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "bench/live_daemon.h"
#include "bench/timing.h"
#include "daemon/past.h"
#include "daemon/rebuild.h"
#include "daemon/service.h"
#include "knowledge/configuration.h"
#include "lcmtypes/codec.h"

namespace {

using namespace anchord;
using bench::fail;
using bench::ms_since;
using Clock = std::chrono::steady_clock;

constexpr Utime kStart = 1'700'000'000'000'000, kApart = 100'000;

constexpr char kScene[] = R"({
  "world": {"dimensions": 3, "bounds": {"min": [0, 0, 0], "max": [10, 8, 3]}},
  "places": [{"name": "left", "polygon": [[0, 0], [5, 0], [5, 8], [0, 8]]},
             {"name": "right", "polygon": [[5, 0], [10, 0], [10, 8], [5, 8]]}],
  "attributes": {"class": {"kind": "categorical", "symbols": ["cup", "tea_box", "bowl"]}},
  "classes": {"default": {"models": [{"kind": "constant_position", "position_psd": 1e-5},
                                     {"kind": "somewhere", "rate": 1e-4}]}},
  "sensors": {"default": {"clutter_density": 1e-4}}
})";

/// What the camera sees at a time: each object moves every ten minutes, not all at once.
Frame frame_at(std::int64_t k) {
  constexpr const char* kClasses[] = {"cup", "tea_box", "bowl"};
  Frame frame;
  frame.utime = kStart + k * kApart;
  frame.sensor = "camera";
  frame.view.emplace().type = View::Type::kWorld;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<double>((k + i * 2000) / 6000);
    const double noise = 0.01 * std::sin(static_cast<double>(k * 7 + i));
    Detection& seen = frame.detections.emplace_back();
    seen.measurement = CartesianMeasurement{
        {5 + 4 * std::sin(at + i) + noise, 4 + 3 * std::cos(at * 1.3 + i), 0.9},
        {1e-4, 0, 0, 0, 1e-4, 0, 0, 0, 1e-4}};
    seen.attributes = {{"class", SymbolReport{{{kClasses[i], 0.9}}}}};
  }
  return frame;
}

double megabytes(const std::string& directory) {
  double sum = 0;
  for (const auto& file : std::filesystem::directory_iterator(directory))
    sum += static_cast<double>(file.file_size()) * 1e-6;
  return sum;
}

void make_log(const std::string& directory, const Knowledge& knowledge, std::int64_t frames) {
  auto log = FrameLog::open(directory);
  if (!log) fail(log.error().text());
  if ((*log)->last_sequence() >= frames) return;
  if (Status put = (*log)->put_configuration({1, knowledge.text}); !put) fail(put.error().text());
  for (std::int64_t k = (*log)->last_sequence() + 1; k <= frames; ++k) {
    const Frame frame = frame_at(k);
    const Status kept = (*log)->append({LoggedFrame::Kind::kFrame, k, frame.utime, frame.robot,
                                        frame.sensor, canonical_bytes(frame)});
    if (!kept) fail(kept.error().text());
    if (k % 10'000 == 0 || k == frames)
      if (Status done = (*log)->commit(); !done) fail(done.error().text());
  }
  log->reset();
  const auto begin = Clock::now();
  const auto rebuilt = rebuild(directory, [](std::int64_t, std::int64_t) {});
  if (!rebuilt) fail(rebuilt.error().text());
  std::printf("folded in %.1f s, checkpoints of %.1f MB\n", ms_since(begin) * 1e-3,
              static_cast<double>(rebuilt->checkpoints) * 1e-6);
}

/// From the start of a daemon to its first answer, ms.
double start(const std::string& directory, const Knowledge& knowledge) {
  const auto begin = Clock::now();
  ServiceOptions options;
  options.data_directory = directory;
  options.http_address = "127.0.0.1:0";
  options.lcm_url = bench::kLcmUrl;
  options.lcm_receiver = ANCHORD;
  auto service = Service::open(knowledge, options);
  if (!service) fail(service.error().text());
  if (Status started = (*service)->start(std::atomic<bool>{false}); !started)
    fail(started.error().text());
  const double ms = ms_since(begin);
  (*service)->stop();
  return ms;
}

}  // namespace

int main(int argc, char** argv) {
  spdlog::set_level(spdlog::level::warn);
  const std::int64_t frames = argc > 1 ? std::atoll(argv[1]) : 100'000;
  std::string directory =
      argc > 2 ? argv[2] : std::filesystem::temp_directory_path() / "anchord-long-XXXXXX";
  if (argc <= 2 && !mkdtemp(directory.data())) fail("cannot make a folder");
  const auto configuration = parse_configuration(kScene);
  if (!configuration.ok()) fail(configuration.mistakes().front().text());
  const Knowledge& knowledge = configuration.knowledge();
  make_log(directory, knowledge, frames);
  std::printf("%lld frames of 3 detections: %.1f MB, %.0f bytes a frame\n",
              static_cast<long long>(frames), megabytes(directory),
              megabytes(directory) * 1e6 / static_cast<double>(frames));
  std::printf("start to ready: %.0f ms\n", start(directory, knowledge));

  bench::Times cold, near;
  Past past(directory, World(knowledge));
  for (int i = 1; i < 40; ++i) {
    const Utime utime = kStart + frames * kApart / 40 * ((i * 17) % 40);
    auto begin = Clock::now();
    if (!past.at(utime, 0)) fail("no answer");
    cold.add(ms_since(begin));
    begin = Clock::now();
    if (!past.at(utime + 10 * kApart, 0)) fail("no answer");
    near.add(ms_since(begin));
  }
  std::printf("the belief at a time: median %.0f ms, largest %.0f ms; a second later %.1f ms\n",
              cold.median_ms(), cold.max_ms(), near.median_ms());
  if (argc <= 2) std::filesystem::remove_all(directory);
  return 0;
}
