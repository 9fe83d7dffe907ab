#include "video_program.h"

#include <cstdio>
#include <opencv2/core/utils/logger.hpp>

#include "perception/camera_file.h"

namespace anchord {

namespace {

void say(const char* program, const std::string& text) {
  std::fprintf(stderr, "%s: %s\n", program, text.c_str());
}

}  // namespace

void add_camera_option(CLI::App& app, std::string& camera_file) {
  app.add_option("--camera", camera_file, "the camera's file")->capture_default_str();
}

void add_video_options(CLI::App& app, Video::Settings& video) {
  app.add_option("--fps", video.fps, "frames per second of a file; default: as it says")
      ->check(CLI::Range(0.01, 1000.0));
  app.add_option("--start-utime", video.start_utime,
                 "time of a file's first frame, microseconds since 1970; default: now")
      ->check(CLI::Range(kEarliestUtime, kLatestUtime));
}

std::optional<DetectorSettings> camera_settings(const char* program, const std::string& file) {
  ConfigurationMistakes mistakes;
  auto settings = read_camera_file(file, mistakes);
  for (const auto& mistake : mistakes) say(program, "--camera: " + mistake.text());
  return settings;
}

int fail(const char* program, const Error& error) {
  say(program, error.text());
  return kFailed;
}

int refuse_option(const char* program, const Error& error) {
  say(program, error.text());
  return kWrongCall;
}

int run_program(const char* program, CLI::App& app, int argc, char** argv,
                const std::function<int()>& run) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kWrongCall;
  }
  try {
    cv::setNumThreads(1);
    cv::utils::logging::setLogLevel(
        cv::utils::logging::LOG_LEVEL_SILENT);  // errors are ours to say
    return run();
  } catch (const std::exception& error) {
    say(program, error.what());
    return kFailed;
  }
}

}  // namespace anchord
