#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "knowledge/configuration.h"

namespace anchord {
namespace {

namespace fs = std::filesystem;

const std::string kWorld = R"("world": {"bounds": {"min": [0, 0, 0], "max": [10, 8, 3]}})";
std::string all_text(const Configuration& configuration) {
  std::string text;
  for (const ConfigurationMistake& mistake : configuration.mistakes()) {
    text += mistake.text() + "\n";
  }
  return text;
}

Knowledge knowledge_of(const Configuration& configuration) {
  EXPECT_TRUE(configuration.ok()) << all_text(configuration);
  return configuration.ok() ? configuration.knowledge() : Knowledge{};
}

/// A folder of its own, gone at the end.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "anchord-configuration-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

TEST(ConfigurationInclude, TheIncludingFileWinsAndPlacesAreJoined) {
  const Folder folder;
  folder.write("parts/rooms.json", R"({"places": [
      {"name": "kitchen", "polygon": [[0, 0], [4, 0], [4, 3]]}]})");
  folder.write("parts/base.json", "{" + kWorld + R"(, "include": "rooms.json",
      "sensors": {"default": {"clutter_density": 0.1, "pose_floor": 0.2}},
      "hypotheses": {"max": 7}})");
  folder.write("late.json", R"({"hypotheses": {"max": 8, "scan_depth": 9}})");
  const Knowledge knowledge = knowledge_of(read_configuration(folder.write("main.json", R"({
      "include": ["parts/base.json", "parts/rooms.json", "late.json"],
      "places": [{"name": "table", "parent": "kitchen", "polygon": [[0, 0], [1, 0], [1, 1]]}],
      "sensors": {"default": {"clutter_density": 0.3}}})")));
  ASSERT_EQ(knowledge.places.size(), 2u);  // rooms.json is included twice and counts once
  EXPECT_EQ(knowledge.places[0].name, "kitchen");
  EXPECT_EQ(knowledge.places[1].parent, 0);
  EXPECT_EQ(knowledge.default_sensor.clutter_density, 0.3);
  EXPECT_EQ(knowledge.default_sensor.pose_floor, 0.2);
  EXPECT_EQ(knowledge.limits.max_hypotheses, 8);
  EXPECT_EQ(knowledge.limits.scan_depth, 9);
}

TEST(ConfigurationInclude, CyclesMissingFilesAndBadJsonAreMistakes) {
  const Folder folder;
  folder.write("a.json", R"({"include": "b.json"})");
  folder.write("b.json", R"({"include": ["a.json"]})");
  folder.write("broken.json", "{\"world\": \n}");
  const Configuration configuration = read_configuration(
      folder.write("main.json", R"({"include": ["a.json", "no.json", 3, "broken.json", "."]})"));
  const ConfigurationMistakes mistakes = configuration.mistakes();
  ASSERT_EQ(mistakes.size(), 5u) << all_text(configuration);
  EXPECT_EQ(mistakes[0].path, "include[0]");
  EXPECT_NE(mistakes[0].message.find("a.json includes itself"), std::string::npos);
  EXPECT_EQ(mistakes[1].path, "include[1]");
  EXPECT_NE(mistakes[1].message.find("no.json does not exist"), std::string::npos);
  EXPECT_EQ(mistakes[2].path, "include[2]");
  EXPECT_EQ(mistakes[3].path, "include[3]");
  EXPECT_NE(mistakes[3].message.find("broken.json: parse error at line 2"), std::string::npos);
  EXPECT_EQ(mistakes[4].path, "include[4]");
  EXPECT_NE(mistakes[4].message.find("no regular file"), std::string::npos);
}

TEST(ConfigurationInclude, AFileThatIsNotThereIsOneMistake) {
  const Folder folder;
  const auto mistakes = read_configuration(folder.path() / "none.json").mistakes();
  ASSERT_EQ(mistakes.size(), 1u);
  EXPECT_NE(mistakes[0].message.find("none.json does not exist"), std::string::npos);
}

}  // namespace
}  // namespace anchord
