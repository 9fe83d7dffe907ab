#pragma once

#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/frame.h"

/// Random frames for the properties of the codecs.
namespace anchord::testing {

/// Any finite number, the awkward ones often.
inline rc::Gen<double> numbers() {
  using Limits = std::numeric_limits<double>;
  return rc::gen::oneOf(
      rc::gen::arbitrary<double>(),
      rc::gen::element(0.0, -0.0, 0.1, Limits::max(), Limits::lowest(), Limits::min(),
                       Limits::denorm_min(), 1.0 / 3, 9007199254740993.0, 1e21));
}

inline rc::Gen<std::vector<double>> numbers(std::size_t count) {
  return rc::gen::container<std::vector<double>>(count, numbers());
}

template <std::size_t n>
std::array<double, n> random_array() {
  const std::vector<double> list = *numbers(n);
  std::array<double, n> out;
  std::copy(list.begin(), list.end(), out.begin());
  return out;
}

inline rc::Gen<std::string> texts() {
  const auto piece = rc::gen::element<std::string>("a", "Z", "0", "_", "-", " ", "\"", "\\", "[",
                                                   "\u00e9", "\u4e2d", "\U0001f375");
  return rc::gen::map(rc::gen::container<std::vector<std::string>>(piece),
                      [](const std::vector<std::string>& pieces) {
                        std::string text;
                        for (const std::string& part : pieces) text += part;
                        return text.substr(0, pieces.size() > 50 ? 0 : std::string::npos);
                      });
}

inline rc::Gen<std::string> names() {
  return rc::gen::map(texts(), [](const std::string& text) { return "n" + text; });
}

/// In order and without repeats, as JSON brings them out.
inline std::vector<std::string> random_name_set() {
  auto list = *rc::gen::container<std::vector<std::string>>(*rc::gen::inRange(0, 5), names());
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

inline View random_view() {
  View view;
  view.type = static_cast<View::Type>(*rc::gen::inRange(0, 5));
  const bool sector = view.type == View::Type::kSector;
  const bool frustum = view.type == View::Type::kFrustum;
  if (sector || frustum) view.range = random_array<2>();
  if (sector) {
    view.bearing = random_array<2>();
    view.elevation = random_array<2>();
  }
  if (frustum) {
    view.hfov = *numbers();
    view.vfov = *numbers();
  }
  if (view.type == View::Type::kPolygon) {
    view.points.resize(*rc::gen::inRange<std::size_t>(0, 6));
    for (auto& point : view.points) point = random_array<2>();
  }
  return view;
}

inline Detection random_detection() {
  Detection detection;
  const bool with_noise = *rc::gen::arbitrary<bool>();
  if (*rc::gen::arbitrary<bool>()) {
    // Without covariance LCM cannot tell 2 numbers from 3.
    const std::size_t dims = with_noise ? *rc::gen::element<std::size_t>(2, 3) : 3;
    detection.measurement =
        CartesianMeasurement{*numbers(dims), *numbers(with_noise ? dims * dims : 0)};
  } else {
    const auto polar = random_array<3>();
    detection.measurement =
        PolarMeasurement{polar[0], polar[1], polar[2], *numbers(with_noise ? 3 : 0)};
  }
  if (*rc::gen::arbitrary<bool>()) detection.score = *numbers();
  if (*rc::gen::arbitrary<bool>()) detection.yaw = *numbers();
  detection.object = *texts();
  for (const std::string& name : random_name_set()) {
    if (*rc::gen::arbitrary<bool>()) {
      detection.attributes.push_back({name, ScalarReport{*numbers(), *numbers()}});
    } else {
      SymbolReport report;
      for (const std::string& symbol : random_name_set()) {
        report.probabilities.emplace_back(symbol, *numbers());
      }
      detection.attributes.push_back({name, report});
    }
  }
  return detection;
}

/// A frame as both codecs give it back exactly.
inline Frame random_frame() {
  Frame frame;
  frame.utime = *rc::gen::arbitrary<Utime>();
  frame.robot = *texts();
  frame.sensor = *names();
  if (*rc::gen::arbitrary<bool>()) {
    frame.pose = Pose{random_array<3>(), random_array<4>(), random_array<36>()};
  }
  if (*rc::gen::arbitrary<bool>()) frame.view = random_view();
  frame.detections.resize(*rc::gen::inRange<std::size_t>(0, 5));
  for (Detection& detection : frame.detections) detection = random_detection();
  return frame;
}

}  // namespace anchord::testing
