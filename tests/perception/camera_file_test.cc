#include "perception/camera_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "knowledge/configuration.h"
#include "plaza.h"

namespace anchord {
namespace {

std::vector<std::string> mistakes_of(const std::string& text) {
  ConfigurationMistakes mistakes;
  EXPECT_FALSE(parse_camera_file(text, "", mistakes));
  std::vector<std::string> paths;
  for (const auto& mistake : mistakes) paths.push_back(mistake.path);
  return paths;
}

bool among(const std::vector<std::string>& paths, const std::string& path) {
  return std::find(paths.begin(), paths.end(), path) != paths.end();
}

TEST(CameraFile, ThePlazasIsRead) {
  ConfigurationMistakes mistakes;
  const auto settings = read_camera_file(project_file("config/plaza.camera.json"), mistakes);
  ASSERT_TRUE(settings) << (mistakes.empty() ? "" : mistakes[0].text());
  EXPECT_EQ(settings->camera.width, 768);
  EXPECT_EQ(settings->view.size(), 4U);
  EXPECT_EQ(settings->occluders.size(), 2U);
}

TEST(CameraFile, TheDaemonKnowsItsColors) {
  const Configuration configuration = read_configuration(project_file("config/plaza.json"));
  ASSERT_TRUE(configuration.ok()) << configuration.mistakes()[0].text();
  const Knowledge& knowledge = configuration.knowledge();
  const int color = knowledge.find_attribute("color");
  ASSERT_GE(color, 0);
  for (const NamedColor& named : plaza_settings().clothes.colors) {
    EXPECT_GE(knowledge.attributes[static_cast<std::size_t>(color)].find(named.name), 0)
        << named.name;
  }
  EXPECT_GE(knowledge.find_class("person"), 0);
}

TEST(CameraFile, NamesAllThatIsMissing) {
  const auto paths = mistakes_of("{}");
  EXPECT_TRUE(among(paths, "camera"));
  EXPECT_TRUE(among(paths, "view"));
  EXPECT_TRUE(among(paths, "colors"));
}

TEST(CameraFile, NamesEveryMistake) {
  const auto paths = mistakes_of(R"({
    "camera": {"image": [768, 576], "focal": -1, "kappa1": 0, "center": [0, 0], "sx": 1,
               "pixel": [0.005, 0], "rotation": [0, 0], "translation": [0, 0, 1], "zoom": 2},
    "view": [[0, 0], [1, 1]],
    "people": {"least_gain": "much"},
    "colors": [{"name": "red", "value": [0, 2]}]})");
  for (const char* path : {"camera.focal", "camera.zoom", "view", "people.least_gain"}) {
    EXPECT_TRUE(among(paths, path)) << path;
  }
  for (const char* start : {"camera.pixel", "camera.rotation", "colors[0].value"}) {
    EXPECT_TRUE(std::any_of(paths.begin(), paths.end(), [&](const std::string& path) {
      return path.starts_with(start);
    })) << start;
  }
}

/// A camera's file without rotation and translation, with more of the camera and of the file.
std::string without_place(const std::string& camera, const std::string& more) {
  return R"({"camera": {"image": [64, 48], "focal": 1, "kappa1": 0, "center": [0, 0], "sx": 1,
                        "pixel": [1, 1])" +
         camera + R"(}, "colors": [{"name": "red"}])" + more + "}";
}

TEST(CameraFile, WithoutAPlaceTheCameraIsCarried) {
  ConfigurationMistakes mistakes;
  const auto settings = parse_camera_file(without_place("", ""), "", mistakes);
  ASSERT_TRUE(settings) << mistakes[0].text();
  EXPECT_TRUE(settings->camera.carried);
  EXPECT_FALSE(plaza_settings().camera.carried);
}

/// The first indented object of a document.
std::string example_of(const std::filesystem::path& document) {
  std::ifstream in(document);
  std::string line, example;
  while (std::getline(in, line)) {
    if (example.empty() && line != "    {") continue;
    example += line + "\n";
    if (line == "    }") break;
  }
  return example;
}

TEST(CameraFile, TheManualsExampleIsACarriedCamera) {
  ConfigurationMistakes mistakes;
  const auto settings = parse_camera_file(example_of(project_file("docs/verification.md")),
                                          project_file("."), mistakes);
  ASSERT_TRUE(settings) << mistakes[0].text();
  EXPECT_TRUE(settings->camera.carried);
  EXPECT_EQ(settings->verification.appearances.at("cup").colors, std::vector<std::string>{"red"});
}

TEST(CameraFile, HalfAPlaceIsAMistake) {
  EXPECT_TRUE(
      among(mistakes_of(without_place(R"(, "rotation": [0, 0, 0])", "")), "camera.translation"));
  EXPECT_TRUE(
      among(mistakes_of(without_place(R"(, "translation": [0, 0, 0])", "")), "camera.rotation"));
}

TEST(CameraFile, ACarriedCameraHasNoFixedPixels) {
  EXPECT_EQ(mistakes_of(without_place("", R"(, "occluders": [[[0, 0], [1, 0], [0, 1]]])")),
            std::vector<std::string>{"occluders"});
  EXPECT_EQ(mistakes_of(without_place("", R"(, "view": [[0, 0], [1, 0], [0, 1]])")),
            std::vector<std::string>{"view"});
}

/// A camera's file with what it needs, and a verification section.
std::string with_verification(const std::string& section) {
  return R"({"camera": {"image": [64, 48], "focal": 1, "kappa1": 0, "center": [0, 0], "sx": 1,
                        "pixel": [1, 1], "rotation": [0, 0, 0], "translation": [0, 0, 1]},
             "view": [[0, 0], [1, 0], [0, 1]], "colors": [{"name": "red"}], "verification": )" +
         section + "}";
}

TEST(CameraFile, TellsWhatIsVerifiedAndHow) {
  ConfigurationMistakes mistakes;
  const auto settings = parse_camera_file(with_verification(R"({"looks": 5, "least_visible": 0.9,
                            "appearances": {"cat": {"color": ["red"], "extent": [1, 2, 3]}}})"),
                                          "", mistakes);
  ASSERT_TRUE(settings) << mistakes[0].text();
  EXPECT_EQ(settings->verification.looks, 5);
  EXPECT_EQ(settings->verification.least_visible, 0.9);
  const auto& cat = settings->verification.appearances.at("cat");
  EXPECT_EQ(cat.colors, std::vector<std::string>{"red"});
  EXPECT_EQ(cat.extent, (std::array<double, 3>{1, 2, 3}));
}

TEST(CameraFile, NamesMistakesInVerification) {
  const auto paths = mistakes_of(with_verification(
      R"({"looks": 0, "luck": 1, "appearances": {"cat": {"color": ["rad"], "extent": [1]}}})"));
  for (const char* start :
       {"verification.looks", "verification.luck", "verification.appearances.cat.color[0]",
        "verification.appearances.cat.extent"}) {
    EXPECT_TRUE(std::any_of(paths.begin(), paths.end(), [&](const std::string& path) {
      return path.starts_with(start);
    })) << start;
  }
}

TEST(CameraFile, RefusesWhatIsNoJson) {
  EXPECT_FALSE(mistakes_of("{").empty());
  EXPECT_FALSE(mistakes_of("[]").empty());
}

}  // namespace
}  // namespace anchord
