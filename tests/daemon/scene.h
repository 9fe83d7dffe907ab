#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "api/frame_json.h"
#include "core/frame.h"
#include "knowledge/configuration.h"

namespace anchord {

/// A kitchen with two classes, for whoever needs a world and not this one in particular.
inline constexpr char kScene[] = R"({
  "world": {"bounds": {"min": [0, 0, 0], "max": [10, 8, 3]}, "cell": 1},
  "places": [{"name": "kitchen", "kind": "room", "polygon": [[0, 0], [5, 0], [5, 8], [0, 8]]}],
  "attributes": {"class": {"kind": "categorical", "symbols": ["cup", "tea_box"]},
                 "color": {"kind": "categorical", "symbols": ["red", "blue"]},
                 "size": {"kind": "scalar", "unit": "m", "predicates": {"small": [0, 0.15]}}},
  "classes": {"default": {"detection_probability": 0.9}},
  "sensors": {"default": {"clutter_density": 1e-3}, "kinect": {"clutter_density": 1e-4}}
})";

inline Knowledge scene() {
  const auto configuration = parse_configuration(kScene);
  EXPECT_TRUE(configuration.ok());
  return configuration.knowledge();
}

/// The test's epoch, in November 2023.
inline constexpr Utime kStart = 1'700'000'000'000'000;

/// A cup at (2, 3), a tea box at (6, 4), both a little beside it in each frame, 33 ms apart.
inline Frame frame_number(int number, const std::string& sensor = "kinect") {
  Frame frame;
  frame.utime = kStart + number * Utime{33'000};
  frame.sensor = sensor;
  frame.view.emplace().type = View::Type::kWorld;
  const double beside = 0.02 * std::sin(number);
  for (const bool cup : {true, false}) {
    Detection& seen = frame.detections.emplace_back();
    seen.measurement = CartesianMeasurement{{(cup ? 2 : 6) + beside, cup ? 3.0 : 4.0, 0.9},
                                            {1e-3, 0, 0, 0, 1e-3, 0, 0, 0, 1e-3}};
    seen.attributes = {{"class", SymbolReport{{{cup ? "cup" : "tea_box", 0.8}}}},
                       {"color", SymbolReport{{{cup ? "red" : "blue", 0.9}}}}};
  }
  return frame;
}

inline std::string json(const Frame& frame) { return to_json(frame).dump(); }

/// A folder that goes with its test.
class TestFolder {
 public:
  TestFolder() {
    std::string name = ::testing::TempDir() + "/anchord-XXXXXX";
    path_ = mkdtemp(name.data());
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  /// Writes a file there, at once for whoever is reading it, and says where it is.
  std::string write(const std::string& name, const std::string& text) const {
    const std::string path = *this / name;
    std::ofstream(path + ".new") << text;
    std::filesystem::rename(path + ".new", path);
    return path;
  }

 private:
  std::string path_;
};

}  // namespace anchord
