// anchor-detect: people in a video or a live camera, as frames of detections.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "outputs.h"
#include "perception/person_detector.h"
#include "video_program.h"

namespace anchord {
namespace {

constexpr const char* kProgram = "anchor-detect";

struct Options {
  std::string camera_file = "config/plaza.camera.json";
  double learn_s = 40;
  int most_frames = 0;
  bool fast = false;
  Video::Settings video;
  Outputs::Settings outputs;
};

int run(Options options) {
  const auto settings = camera_settings(kProgram, options.camera_file);
  if (!settings) return kWrongCall;
  if (settings->camera.carried) {
    return refuse_option(kProgram, invalid("--camera",
                                           "has no rotation and translation: people "
                                           "are detected by a camera that stands still"));
  }

  options.video.size = {settings->camera.width, settings->camera.height};
  auto video = Video::open(options.video);
  if (!video) return fail(kProgram, video.error());
  auto outputs = Outputs::open(options.outputs);
  if (!outputs) return fail(kProgram, outputs.error());
  const std::vector<cv::Mat> background = video->learn(options.learn_s);
  if (background.empty()) return fail(kProgram, invalid(options.video.input, "holds no picture"));
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
    if (!done) return fail(kProgram, done.error());
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
  anchord::add_camera_option(app, options.camera_file);
  anchord::add_video_options(app, options.video);
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
  return anchord::run_program(anchord::kProgram, app, argc, argv, [&] {
    if (lcm->count() > 0 || (options.outputs.log.empty() && options.outputs.jsonl.empty() &&
                             options.outputs.features.empty())) {
      options.outputs.lcm_url = url;
    }
    return anchord::run(options);
  });
}
