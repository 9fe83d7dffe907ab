#pragma once

#include <filesystem>

#include "perception/camera_file.h"

namespace anchord {

/// The project's own file: tests see the camera that users see.
inline std::filesystem::path project_file(const char* path) {
  return std::filesystem::path(ANCHORD_SOURCE_DIR) / path;
}

inline DetectorSettings plaza_settings() {
  ConfigurationMistakes mistakes;
  return read_camera_file(project_file("config/plaza.camera.json"), mistakes).value();
}

}  // namespace anchord
