#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>

#include "core/result.h"
#include "perception/detector_settings.h"
#include "video.h"

namespace anchord {

/// What the programs have in common that read a camera's pictures. `program` is a program's name;
/// all that they say goes to standard error behind it.

/// Exit statuses.
inline constexpr int kFailed = 1, kWrongCall = 2;

/// The option --camera.
void add_camera_option(CLI::App& app, std::string& camera_file);

/// The options --fps and --start-utime, of a video file.
void add_video_options(CLI::App& app, Video::Settings& video);

/// What the camera's file says; nothing, and every mistake said, where it is wrong.
std::optional<DetectorSettings> camera_settings(const char* program, const std::string& file);

/// Says why the program fails; kFailed.
int fail(const char* program, const Error& error);

/// Says what is wrong with an option; kWrongCall.
int refuse_option(const char* program, const Error& error);

/// Reads the arguments and runs: the exit status. No exception gets out.
int run_program(const char* program, CLI::App& app, int argc, char** argv,
                const std::function<int()>& run);

}  // namespace anchord
