#include "tools/anchor_tune/recording.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace anchord::tuning {
namespace {

class RecordingTest : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& content) {
    const std::string path = testing::TempDir() + "anchor_tune_" + name;
    std::ofstream(path) << content;
    return path;
  }
};

TEST_F(RecordingTest, ReadsTruthByTheNamesOfItsColumns) {
  const auto truth = read_truth(file("t.csv", "id,frame,y,x,ignore,class\nb,7,2,1,1,cup\r\n\n"),
                                file("i.csv", "utime,frame\n1000,7\n2000,8\n"));
  ASSERT_TRUE(truth.ok());
  ASSERT_EQ(truth->size(), 2u);
  const TruthRow& row = truth->at(1000).at(0);
  EXPECT_EQ(row.id, "b");
  EXPECT_EQ(row.class_name, "cup");
  EXPECT_TRUE(row.neutral);
  EXPECT_EQ(row.position, Eigen::Vector3d(1, 2, 0));
  EXPECT_TRUE(truth->at(2000).empty()) << "nothing was there, which is known";
}

TEST_F(RecordingTest, SaysWhereATruthIsWrong) {
  const std::string index = file("i.csv", "utime,frame\n1000,7\n");
  const auto text = [&](const std::string& rows) {
    const auto truth = read_truth(file("t.csv", rows), index);
    return truth.ok() ? "" : truth.error().text();
  };
  EXPECT_NE(text("frame,id,x\n").find("t.csv:1: has no column \"y\""), std::string::npos);
  EXPECT_NE(text("frame,id,x,y\n7,a,1,one\n").find("t.csv:2: \"one\" is no number (column y)"),
            std::string::npos);
  EXPECT_NE(text("frame,id,x,y\n7,a,1,nan\n").find("is no number"), std::string::npos);
  EXPECT_NE(text("frame,id,x,y\n7,a,1\n").find("is no number"), std::string::npos);
  EXPECT_NE(text("frame,id,x,y\n9,a,1,1\n").find("frame 9 is not in the index"), std::string::npos);
  EXPECT_FALSE(read_truth("/nowhere.csv", index).ok());
}

TEST_F(RecordingTest, FramesComeInOrderOfTime) {
  const auto frames =
      read_frames(file("f.jsonl", R"({"utime": 1700000000200000, "sensor": "b", "detections": []})"
                                  "\n"
                                  R"({"utime": 1700000000100000, "sensor": "a", "detections": []})"
                                  "\n"),
                  2);
  ASSERT_TRUE(frames.ok()) << frames.error().text();
  ASSERT_EQ(frames->size(), 2u);
  EXPECT_EQ((*frames)[0].sensor, "a");
  const auto bad = read_frames(file("f.jsonl", "{}\n{\n"), 2);
  ASSERT_FALSE(bad.ok());
  EXPECT_NE(bad.error().text().find("f.jsonl:"), std::string::npos);
}

}  // namespace
}  // namespace anchord::tuning
