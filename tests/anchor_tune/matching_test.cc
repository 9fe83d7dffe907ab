#include "tools/anchor_tune/matching.h"

#include <gtest/gtest.h>

#include "tests/anchoring/small_world.h"

namespace anchord::tuning {
namespace {

/// One frame at second 0 in small_world(): 6 x 4 m, classes cup and box.
JudgedFrame judged(std::vector<Detection> detections, std::vector<TruthRow> rows,
                   double radius = 0.5) {
  Recording recording;
  recording.frames = {frame(0, std::move(detections))};
  recording.truth = Truth{{at_second(0), std::move(rows)}};
  const auto judgement = judge({recording}, radius, Background(small_world()));
  EXPECT_TRUE(judgement.ok());
  return judgement->frames.at(0);
}

TruthRow row(const std::string& id, double x, double y, const std::string& object_class = "cup",
             bool neutral = false) {
  return {id, {x, y, 0}, object_class, neutral};
}

TEST(Matching, IsOneToOneWithTheLeastDistance) {
  const auto f = judged({at(1.3, 1), at(1.1, 1), at(4, 1)}, {row("a", 1, 1), row("b", 1.4, 1)});
  EXPECT_EQ(f.detections[0].object, "b");
  EXPECT_EQ(f.detections[1].object, "a");
  EXPECT_NEAR(f.detections[1].residual.x(), 0.1, 1e-12);
  EXPECT_EQ(f.detections[2].verdict, Verdict::kFalse);
  EXPECT_TRUE(f.sights[0].found && f.sights[1].found);
  EXPECT_NEAR(f.volume, 24, 1e-9);
}

TEST(Matching, BeyondTheRadiusNothingIsFound) {
  const auto f = judged({at(1.6, 1)}, {row("a", 1, 1)});
  EXPECT_EQ(f.detections[0].verdict, Verdict::kFalse);
  EXPECT_FALSE(f.sights[0].found);
}

TEST(Matching, TheReportedClassDecidesBetweenNearOnes) {
  const auto f = judged({at(1.05, 1, "class", "box", 0.9), at(1.1, 1, "class", "cup", 0.9)},
                        {row("a", 1, 1, "cup")});
  EXPECT_EQ(f.detections[0].verdict, Verdict::kFalse);
  EXPECT_EQ(f.detections[1].object, "a");
}

TEST(Matching, NeutralRowsAreNeitherFoundNorFalse) {
  const auto f = judged({at(1, 1), at(1.2, 1), at(3, 1), at(5, 1)},
                        {row("a", 1, 1, "cup", true), row("b", 3, 1, "lorry"), row("c", 5, 1)});
  EXPECT_EQ(f.detections[0].verdict, Verdict::kNeutral);
  EXPECT_EQ(f.detections[1].verdict, Verdict::kNeutral) << "left over beside a neutral one";
  EXPECT_EQ(f.detections[2].verdict, Verdict::kNeutral) << "of no class that is configured";
  EXPECT_EQ(f.detections[3].verdict, Verdict::kRight);
  ASSERT_EQ(f.sights.size(), 1u);
  EXPECT_EQ(f.sights[0].object, "c");
}

TEST(Matching, OutOfViewNothingCounts) {
  Recording recording;
  recording.frames = {frame(0, {at(5, 1)})};
  View& left = recording.frames[0].view.emplace();
  left.type = View::Type::kPolygon;
  left.points = {{0, 0}, {3, 0}, {3, 4}, {0, 4}};
  recording.truth = Truth{{at_second(0), {row("a", 5, 1), row("b", 1, 1)}}};
  const auto judgement = judge({recording}, 0.5, Background(small_world()));
  const auto& f = judgement->frames.at(0);
  EXPECT_EQ(f.detections[0].verdict, Verdict::kNeutral);
  ASSERT_EQ(f.sights.size(), 1u);
  EXPECT_EQ(f.sights[0].object, "b");
  EXPECT_NEAR(f.volume, 12, 0.05 * 24);  // cells on the edge are sampled
}

TEST(Matching, AGapInTheTruthIsAMiss) {
  Recording recording;
  recording.frames = {frame(0, {at(1, 1)}), frame(1, {}), frame(2, {at(3, 1)}), frame(3, {})};
  recording.truth = Truth{{at_second(0), {row("a", 1, 1)}},
                          {at_second(1), {}},
                          {at_second(2), {row("a", 3, 1)}},
                          {at_second(3), {}}};
  const auto judgement = judge({recording}, 0.5, Background(small_world()));
  ASSERT_TRUE(judgement.ok());
  const auto& gap = judgement->frames.at(1).sights;
  ASSERT_EQ(gap.size(), 1u);
  EXPECT_FALSE(gap[0].found);
  EXPECT_NEAR(gap[0].position.x(), 2, 1e-12);
  EXPECT_TRUE(judgement->frames.at(3).sights.empty()) << "it is gone";
}

TEST(Matching, FramesWithoutTruthOnlyShowSpace) {
  Recording recording;
  recording.frames = {frame(0, {at(1, 1)}), frame(1, {})};
  recording.truth = Truth{{at_second(1), {row("a", 1, 1)}}};
  const auto judgement = judge({recording}, 0.5, Background(small_world()));
  ASSERT_EQ(judgement->frames.size(), 1u);
  EXPECT_NEAR(judgement->frames[0].new_volume, 0, 1e-9);
  EXPECT_NEAR(judgement->frames[0].old_seconds, 24, 1e-9);
  EXPECT_TRUE(judgement->frames[0].sights.at(0).seen_before);
}

TEST(Matching, RefusesWhatTheEngineRefuses) {
  Recording recording;
  recording.frames = {frame(0, {at(1, 1, "class", "lorry", 0.9)})};
  recording.truth = Truth{};
  const auto judgement = judge({recording}, 0.5, Background(small_world()));
  ASSERT_FALSE(judgement.ok());
  EXPECT_EQ(judgement.error().field, "detections[0].attributes.class.lorry");
}

}  // namespace
}  // namespace anchord::tuning
