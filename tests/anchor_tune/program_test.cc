// The program itself: files in, a configuration out.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>

#include "api/frame_json.h"
#include "knowledge/configuration.h"
#include "tests/anchor_tune/street.h"

namespace anchord::tuning {
namespace {

std::string path_of(const std::string& name) { return testing::TempDir() + "tune_" + name; }

/// Exit status of anchor-tune.
int tune(const std::string& arguments) {
  const std::string call =
      std::string(ANCHOR_TUNE) + " " + arguments + " > " + path_of("out") + " 2> " + path_of("err");
  return WEXITSTATUS(std::system(call.c_str()));
}

std::string content(const std::string& name) {
  std::ifstream in(path_of(name));
  return {std::istreambuf_iterator<char>(in), {}};
}

class TuneProgram : public testing::Test {
 protected:
  void SetUp() override {
    street_.frames = 20;
    const Recording recording = simulate(street_, 5);
    std::ofstream(path_of("base.json")) << configuration_of(street_);
    std::ofstream frames(path_of("frames.jsonl")), truth(path_of("truth.csv")),
        index(path_of("index.csv"));
    for (const Frame& frame : recording.frames) frames << to_json(frame).dump() << "\n";
    truth << "frame,id,x,y\n";
    index << "utime,frame\n";
    int number = 0;
    for (const auto& [utime, rows] : *recording.truth) {
      index << utime << "," << ++number << "\n";
      for (const TruthRow& row : rows)
        truth << number << "," << row.id << "," << row.position.x() << "," << row.position.y()
              << "\n";
    }
  }

  std::string input() const {
    return "--config " + path_of("base.json") + " --input " + path_of("frames.jsonl");
  }
  std::string truth() const {
    return " --truth " + path_of("truth.csv") + " --index " + path_of("index.csv");
  }
  std::string output() const { return " --output " + path_of("tuned.json"); }

  Street street_;
};

TEST_F(TuneProgram, WritesAConfigurationFromTruth) {
  ASSERT_EQ(tune(input() + truth() + output() + " --radius 0.5"), 0) << content("err");
  EXPECT_TRUE(read_configuration(path_of("tuned.json")).ok());
  EXPECT_NE(content("tuned.json").find("// Per m^2: "), std::string::npos);
  EXPECT_NE(content("out").find("sensors.camera.clutter_density "), std::string::npos);
  const std::string first = content("tuned.json");
  ASSERT_EQ(tune(input() + truth() + output() + " --radius 0.5"), 0);
  EXPECT_EQ(content("tuned.json"), first);
}

TEST_F(TuneProgram, WritesAConfigurationFromFramesAlone) {
  ASSERT_EQ(tune(input() + output() + " --evaluations 20"), 0) << content("err");
  EXPECT_TRUE(read_configuration(path_of("tuned.json")).ok());
  EXPECT_NE(content("tuned.json").find("// Maximum likelihood of the frames alone: "),
            std::string::npos);
}

TEST_F(TuneProgram, SaysWhatIsWrong) {
  EXPECT_EQ(tune(input()), 2) << "no output";
  EXPECT_EQ(tune(input() + output() + " --truth " + path_of("truth.csv")), 2);
  EXPECT_NE(content("err").find("every --input needs its --truth and --index"), std::string::npos);
  EXPECT_EQ(tune(input() + output() + " --input nowhere.jsonl"), 1);
  EXPECT_NE(content("err").find("nowhere.jsonl cannot be read"), std::string::npos);
  std::ofstream(path_of("base.json")) << R"({"world": {}})";
  EXPECT_EQ(tune(input() + output()), 2);
  EXPECT_NE(content("err").find("world.bounds"), std::string::npos);
  EXPECT_EQ(tune("--config nowhere.json --input x" + output()), 2);
}

}  // namespace
}  // namespace anchord::tuning
