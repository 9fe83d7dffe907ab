// anchor-detect: people in a video or a live camera, as frames of detections.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <opencv2/core/utils/logger.hpp>
#include <string>
#include <thread>

#include "outputs.h"
#include "perception/camera_file.h"
#include "video.h"

namespace anchord {
namespace {

constexpr int kFailed = 1, kWrongCall = 2;

struct Options {
  std::string camera_file = "config/plaza.camera.json";
  double learn_s = 40;
  int most_frames = 0;
  bool fast = false;
  Video::Settings video;
  Outputs::Settings outputs;
};

int fail(const Error& error) {
  std::fprintf(stderr, "anchor-detect: %s\n", error.text().c_str());
  return kFailed;
}

int run(Options options) {
  ConfigurationMistakes mistakes;
  const auto settings = read_camera_file(options.camera_file, mistakes);
  for (const auto& mistake : mistakes) {
    std::fprintf(stderr, "anchor-detect: --camera: %s\n", mistake.text().c_str());
  }
  if (!settings) return kWrongCall;

  options.video.size = {settings->camera.width, settings->camera.height};
  auto video = Video::open(options.video);
  if (!video) return fail(video.error());
  auto outputs = Outputs::open(options.outputs);
  if (!outputs) return fail(outputs.error());
  const std::vector<cv::Mat> background = video->learn(options.learn_s);
  if (background.empty()) return fail(invalid(options.video.input, "holds no picture"));
  PersonDetector detector(*settings, background);

  using Clock = std::chrono::steady_clock;
  const auto started = Clock::now();
  Clock::duration busy{};
  Utime first = 0;
  int frames = 0;
  std::size_t detections = 0;
  while (options.most_frames == 0 || frames < options.most_frames) {
    const auto picture = video->next();
    if (!picture) break;
    if (frames++ == 0) first = picture->utime;
    if ((*outputs)->live() && !video->live() && !options.fast) {
      std::this_thread::sleep_until(started + std::chrono::microseconds(picture->utime - first));
    }
    const auto begun = Clock::now();
    const std::vector<DetectedPerson> people = detector.detect(picture->picture);
    busy += Clock::now() - begun;
    detections += people.size();
    const auto done = (*outputs)->write(frames, detector.report(people, picture->utime), people);
    if (!done) return fail(done.error());
  }
  std::fprintf(stderr, "%d frames, %zu detections, %.1f ms per frame\n", frames, detections,
               frames ? 1e3 * std::chrono::duration<double>(busy).count() / frames : 0.0);
  return 0;
}

}  // namespace
}  // namespace anchord

int main(int argc, char** argv) {
  CLI::App app{"Detects people in a video or a live camera and publishes them over LCM."};
  anchord::Options options;
  std::string url;
  app.add_option("input", options.video.input, "a video file, or a camera's number")->required();
  app.add_option("--camera", options.camera_file, "the camera's file")->capture_default_str();
  app.add_option("--fps", options.video.fps, "frames per second of a file; default: as it says")
      ->check(CLI::Range(0.01, 1000.0));
  app.add_option("--start-utime", options.video.start_utime,
                 "time of a file's first frame, microseconds since 1970; default: now")
      ->check(CLI::Range(anchord::kEarliestUtime, anchord::kLatestUtime));
  app.add_option("--learn", options.learn_s, "seconds from which the empty scene is learnt")
      ->check(CLI::Range(0.01, 3600.0))
      ->capture_default_str();
  app.add_option("--frames", options.most_frames, "stop after so many; 0: at the end")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--log", options.outputs.log, "write an LCM log");
  app.add_option("--jsonl", options.outputs.jsonl, "write the frames as JSON lines");
  app.add_option("--features", options.outputs.features, "write what was measured, as CSV");
  const auto* lcm =
      app.add_option("--lcm", url, "publish on this LCM URL ('' for the default)")->expected(1);
  app.add_flag("--fast", options.fast, "publish a file as fast as it is worked through");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : anchord::kWrongCall;
  }
  if (lcm->count() > 0 || (options.outputs.log.empty() && options.outputs.jsonl.empty() &&
                           options.outputs.features.empty())) {
    options.outputs.lcm_url = url;
  }
  try {
    cv::setNumThreads(1);
    cv::utils::logging::setLogLevel(
        cv::utils::logging::LOG_LEVEL_SILENT);  // errors are ours to say
    return anchord::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "anchor-detect: %s\n", error.what());
    return anchord::kFailed;
  }
}
