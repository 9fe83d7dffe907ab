// The text of a configuration stands for it; its fingerprint is of what touches the belief.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "knowledge/configuration.h"

namespace anchord {
namespace {

namespace fs = std::filesystem;

Knowledge knowledge_of(const Configuration& configuration) {
  for (const ConfigurationMistake& mistake : configuration.mistakes())
    ADD_FAILURE() << mistake.text();
  return configuration.ok() ? configuration.knowledge() : Knowledge{};
}

/// Each section with something in it.
Knowledge with(const std::string& more = "", const std::string& eye = "") {
  return knowledge_of(parse_configuration(
      R"({"world": {"bounds": {"min": [0, 0, 0], "max": [10, 8, 3]}},
          "sensors": {"eye": {"clutter_density": 0.1, "view": {"type": "world"},
                              "noise": [1, 0, 0, 0, 1, 0, 0, 0, 1])" +
      eye + "}}" + more + "}"));
}

/// The configurations that come with the program.
std::vector<fs::path> shipped() {
  std::vector<fs::path> files;
  const fs::path source = ANCHORD_SOURCE_DIR;
  for (const char* name :
       {"config/home.json", "config/plaza.json", "bench/building.json", "bench/crowd.json"})
    files.push_back(source / name);
  for (const auto& entry : fs::directory_iterator(source / "bench/public"))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  return files;
}

TEST(ConfigurationText, GivesTheSameKnowledge) {
  for (const fs::path& file : shipped()) {
    SCOPED_TRACE(file);
    const Knowledge read = knowledge_of(read_configuration(file));
    const Knowledge again = knowledge_of(parse_configuration(read.text));
    ASSERT_FALSE(read.text.empty());
    EXPECT_EQ(again.text, read.text);
    EXPECT_EQ(again.fingerprint, read.fingerprint);
    EXPECT_EQ(again.whole_fingerprint, read.whole_fingerprint);
    EXPECT_EQ(again.bounds_min, read.bounds_min);
    EXPECT_EQ(again.bounds_max, read.bounds_max);
    EXPECT_EQ(again.cell, read.cell);
    EXPECT_EQ(again.walls, read.walls);
    ASSERT_EQ(again.places.size(), read.places.size());
    for (std::size_t i = 0; i < read.places.size(); ++i) {
      EXPECT_EQ(again.places[i].name, read.places[i].name);
      EXPECT_EQ(again.places[i].region, read.places[i].region);
    }
    ASSERT_EQ(again.classes.size(), read.classes.size());
    for (std::size_t c = 0; c < read.classes.size(); ++c) {
      EXPECT_EQ(again.classes[c].undetected_intensity, read.classes[c].undetected_intensity);
      EXPECT_EQ(again.classes[c].departure_rate, read.classes[c].departure_rate);
      EXPECT_EQ(again.classes[c].models.size(), read.classes[c].models.size());
    }
    ASSERT_EQ(again.sensors.size(), read.sensors.size());
    for (std::size_t s = 0; s < read.sensors.size(); ++s) {
      EXPECT_EQ(again.sensors[s].noise, read.sensors[s].noise);
      EXPECT_EQ(again.sensors[s].confusion, read.sensors[s].confusion);
      EXPECT_EQ(again.sensors[s].detection_probability, read.sensors[s].detection_probability);
    }
  }
}

TEST(ConfigurationText, SaysWhatWasIncludedAndNoComments) {
  const std::string text =
      knowledge_of(read_configuration(fs::path(ANCHORD_SOURCE_DIR) / "config/plaza.json")).text;
  EXPECT_EQ(text.find("include"), std::string::npos);
  EXPECT_EQ(text.find("//"), std::string::npos);
  EXPECT_NE(text.find("color"), std::string::npos);  // of the file that it includes
}

TEST(Fingerprint, IsOfWhatTouchesTheBelief) {
  const Knowledge plain = with();
  const std::vector<Knowledge> same{
      with(R"(, "maintenance": {"enabled": true})"),
      with(R"(, "log": {"keep": 3600, "max_bytes": 1000000, "history_grain": 60})"),
      with("", R"(, "verification": {"cost": 3})")};
  for (const Knowledge& other : same) {
    EXPECT_EQ(other.fingerprint, plain.fingerprint);
    EXPECT_NE(other.whole_fingerprint, plain.whole_fingerprint);
    EXPECT_NE(other.text, plain.text);
  }
  EXPECT_EQ(plain.whole_fingerprint, plain.fingerprint);
  const std::vector<Knowledge> others{with(R"(, "hypotheses": {"max": 7})"),
                                      with("", R"(, "pose_floor": 0.1)")};
  for (const Knowledge& other : others) EXPECT_NE(other.fingerprint, plain.fingerprint);
}

TEST(Fingerprint, OfAllOfItIsWhatOlderProgramsKept) {
  // FNV-1a of {"world":{"bounds":{"max":[1,1,1],"min":[0,0,0]}}}, as they took it.
  EXPECT_EQ(knowledge_of(parse_configuration(
                             R"({"world": {"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}})"))
                .whole_fingerprint,
            0x10bdb43bc11e26e1u);
}

TEST(LogLimits, AreReadAndKeepAllByDefault) {
  EXPECT_EQ(with().log.keep, 0);
  EXPECT_EQ(with().log.max_bytes, 0);
  EXPECT_EQ(with().log.history_grain, 1);
  const LogLimits log =
      with(R"(, "log": {"keep": 86400, "max_bytes": 5000000000, "history_grain": 0.5})").log;
  EXPECT_EQ(log.keep, 86400);
  EXPECT_EQ(log.max_bytes, 5'000'000'000);
  EXPECT_EQ(log.history_grain, 0.5);
}

}  // namespace
}  // namespace anchord
