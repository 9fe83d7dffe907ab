#include "perception/camera_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "knowledge/configuration_file.h"
#include "knowledge/json_reader.h"

namespace anchord {

namespace {

constexpr std::size_t kMostColors = 100, kMostOccluders = 1000;
constexpr Range kPicture{16, 16384};
constexpr Range kWeight{-1e3, 1e3};

/// A member that may not be left out.
std::optional<JsonValue> needed(const JsonValue& in, const char* key) {
  auto value = in.find(key);
  if (!value) in.mistake_at(in.path_of(key), "is missing");
  return value;
}

template <std::size_t n>
std::array<double, n> needed_numbers(const JsonValue& in, const char* key, const Range& range) {
  std::array<double, n> result{};
  if (const auto value = needed(in, key)) {
    if (const auto numbers = value->numbers(n, range)) {
      std::copy(numbers->begin(), numbers->end(), result.begin());
    }
  }
  return result;
}

double needed_number(const JsonValue& in, const char* key, const Range& range) {
  const auto value = needed(in, key);
  return value ? value->number(range).value_or(0) : 0;
}

void read_camera(const JsonValue& in, CameraParameters& camera) {
  if (!in.object_of(
          {"image", "focal", "kappa1", "center", "sx", "pixel", "rotation", "translation"})) {
    return;
  }
  const auto image = needed_numbers<2>(in, "image", kPicture);
  camera.width = static_cast<int>(image[0]);
  camera.height = static_cast<int>(image[1]);
  camera.focal = needed_number(in, "focal", kPositive);
  camera.kappa1 = needed_number(in, "kappa1", kAnyNumber);
  camera.sx = needed_number(in, "sx", kPositive);
  const auto center = needed_numbers<2>(in, "center", kAnyNumber);
  camera.cx = center[0];
  camera.cy = center[1];
  const auto pixel = needed_numbers<2>(in, "pixel", kPositive);
  camera.dpx = pixel[0];
  camera.dpy = pixel[1];
  camera.carried = !in.find("rotation") && !in.find("translation");
  if (camera.carried) return;
  camera.rotation = Eigen::Vector3d(needed_numbers<3>(in, "rotation", kAnyNumber).data());
  camera.translation = Eigen::Vector3d(needed_numbers<3>(in, "translation", kCoordinate).data());
}

/// Pixels that always show the same part of the map, which a carried camera has none of.
std::optional<JsonValue> fixed_pixels(const JsonValue& in, const char* key, bool carried) {
  auto value = in.find(key);
  if (!value || !carried) return value;
  in.mistake_at(in.path_of(key),
                "is for a camera that stands still: camera has no rotation and translation");
  return std::nullopt;
}

std::vector<std::array<double, 2>> pixels(const JsonValue& in) {
  std::vector<std::array<double, 2>> result;
  for (const auto& point : in.polygon().value_or(std::vector<Eigen::Vector2d>{})) {
    result.push_back({point.x(), point.y()});
  }
  return result;
}

void read_background(const JsonValue& in, EmptyScene::Settings& settings) {
  in.object_of({"darkest", "brightest", "threshold", "width", "rate"});
  in.read("darkest", settings.darkest, {0, 1, true});
  in.read("brightest", settings.brightest, {1, 10});
  in.read("threshold", settings.threshold, {0, 442});
  in.read("width", settings.width, {0, 442, true});
  in.read("rate", settings.rate, kProbability);
}

void read_people(const JsonValue& in, PersonSearch::Settings& settings) {
  in.object_of({"height", "height_deviation", "false_foreground", "least_gain", "least_foot_row"});
  in.read("height", settings.height_m, {0.3, 3});
  in.read("height_deviation", settings.height_deviation_m, {0, 1, true});
  in.read("false_foreground", settings.false_foreground, {0, 0.5, true});
  in.read("least_gain", settings.least_gain, {0, 10, true});
  in.read("least_foot_row", settings.least_foot_row, 0, 16384);
}

void read_deviation(const JsonValue& in, DetectorSettings::Noise& noise) {
  in.object_of({"base", "covered", "weak"});
  in.read("base", noise.base, {-10, 2});
  in.read("covered", noise.covered, {0, 10});
  in.read("weak", noise.weak, {0, 10});
}

void read_noise(const JsonValue& in, DetectorSettings& settings) {
  in.object_of({"u", "v", "foot_offset"});
  if (const auto u = in.find("u")) read_deviation(*u, settings.noise_u);
  if (const auto v = in.find("v")) read_deviation(*v, settings.noise_v);
  if (const auto offset = in.find("foot_offset")) {
    if (const auto numbers = offset->numbers(2, {-1, 1})) {
      settings.foot_offset = {(*numbers)[0], (*numbers)[1]};
    }
  }
}

void read_score(const JsonValue& in, DetectorSettings::Score& score) {
  in.object_of({"bias", "gain", "filled", "observed", "alone", "likeness"});
  in.read("bias", score.bias, kWeight);
  in.read("gain", score.gain, kWeight);
  in.read("filled", score.filled, kWeight);
  in.read("observed", score.observed, kWeight);
  in.read("alone", score.alone, kWeight);
  in.read("likeness", score.likeness, kWeight);
}

void read_interval(const JsonValue& in, const char* key, const Range& range,
                   double (&interval)[2]) {
  if (const auto value = in.find(key)) {
    if (const auto numbers = value->numbers(2, range)) {
      interval[0] = (*numbers)[0];
      interval[1] = (*numbers)[1];
    }
  }
}

void read_colors(const JsonValue& in, std::vector<NamedColor>& colors) {
  for (const JsonValue& element : in.elements(kMostColors)) {
    if (!element.object_of({"name", "hue", "saturation", "value"})) continue;
    NamedColor color;
    if (const auto name = needed(element, "name")) color.name = name->name().value_or("");
    read_interval(element, "hue", {0, 360}, color.hue);
    read_interval(element, "saturation", kProbability, color.saturation);
    read_interval(element, "value", kProbability, color.value);
    colors.push_back(color);
  }
  if (colors.empty()) in.mistake("must name at least one color");
}

void read_appearance(const JsonValue& in, const std::vector<NamedColor>& named,
                     VerifierSettings::Appearance& appearance) {
  in.object_of({"color", "extent"});
  if (const auto colors = in.find("color")) {
    for (const JsonValue& each : colors->elements(kMostColors)) {
      const auto name = each.name();
      if (!name) continue;
      const bool known = std::any_of(named.begin(), named.end(),
                                     [&](const NamedColor& color) { return color.name == *name; });
      if (!known) each.mistake("is not one of the colors");
      appearance.colors.push_back(*name);
    }
  }
  if (const auto extent = in.find("extent")) {
    if (const auto numbers = extent->numbers(3, kNotNegative)) {
      std::copy(numbers->begin(), numbers->end(), appearance.extent.begin());
    }
  }
}

void read_verification(const JsonValue& in, DetectorSettings& settings) {
  VerifierSettings& v = settings.verification;
  in.object_of({"appearances", "least_visible", "least_body", "least_score", "least_confidence",
                "size_deviation", "pixel_noise", "edge_noise", "depth_noise", "looks"});
  if (const auto appearances = in.find("appearances")) {
    for (const auto& [name, each] : appearances->members()) {
      read_appearance(each, settings.clothes.colors, v.appearances[name]);
    }
  }
  in.read("least_visible", v.least_visible, kProbability);
  in.read("least_body", v.least_body, kProbability);
  in.read("least_score", v.least_score, kProbability);
  in.read("least_confidence", v.least_confidence, kProbability);
  in.read("size_deviation", v.size_deviation, {0, 1});
  in.read("pixel_noise", v.pixel_noise, {0, 100, true});
  in.read("edge_noise", v.edge_noise, {0, 1});
  in.read("depth_noise", v.depth_noise, {0, 1});
  in.read("looks", v.looks, 1, 1000);
}

std::optional<DetectorSettings> read(const std::optional<nlohmann::json>& document,
                                     ConfigurationMistakes& mistakes) {
  if (!document) return std::nullopt;
  const JsonValue root(*document, "", mistakes);
  DetectorSettings settings;
  if (!root.object_of({"sensor", "camera", "view", "occluders", "background", "people", "noise",
                       "score", "colors", "color_report", "verification"})) {
    return std::nullopt;
  }
  root.read("sensor", settings.sensor);
  if (const auto camera = needed(root, "camera")) read_camera(*camera, settings.camera);
  const bool carried = settings.camera.carried;
  if (!carried) needed(root, "view");
  if (const auto view = fixed_pixels(root, "view", carried)) settings.view = pixels(*view);
  if (const auto occluders = fixed_pixels(root, "occluders", carried)) {
    for (const JsonValue& each : occluders->elements(kMostOccluders)) {
      settings.occluders.push_back(pixels(each));
    }
  }
  if (const auto background = root.find("background")) {
    read_background(*background, settings.background);
  }
  if (const auto people = root.find("people")) read_people(*people, settings.search);
  if (const auto noise = root.find("noise")) read_noise(*noise, settings);
  if (const auto score = root.find("score")) read_score(*score, settings.score);
  if (const auto colors = needed(root, "colors")) read_colors(*colors, settings.clothes.colors);
  if (const auto report = root.find("color_report")) {
    report->object_of({"doubt", "sharpness", "least_pixels"});
    report->read("doubt", settings.clothes.doubt, {0, 1, true});
    report->read("sharpness", settings.clothes.sharpness, {0, 1});
    report->read("least_pixels", settings.clothes.least_pixels, kNotNegative);
  }
  if (const auto verification = root.find("verification")) {
    read_verification(*verification, settings);
  }
  if (!mistakes.empty()) return std::nullopt;
  return settings;
}

}  // namespace

std::optional<DetectorSettings> read_camera_file(const std::filesystem::path& file,
                                                 ConfigurationMistakes& mistakes) {
  return read(load_document(file, mistakes), mistakes);
}

std::optional<DetectorSettings> parse_camera_file(std::string_view text,
                                                  const std::filesystem::path& directory,
                                                  ConfigurationMistakes& mistakes) {
  return read(load_document(text, directory, mistakes), mistakes);
}

}  // namespace anchord
