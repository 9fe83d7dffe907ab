#include <gtest/gtest.h>

#include "maintenance/coordinator.h"
#include "tests/maintenance/small_home.h"

namespace anchord {
namespace {

constexpr Utime kSecond = 1'000'000;

/// One robot and two cups in a room where they wander: cup-1 nearer to the robot than cup-2, and
/// the other way.
class OwnChoice : public testing::TestWithParam<const char*> {
 protected:
  static Knowledge knowledge() {
    RoomOptions options;
    options.maintenance =
        std::string(R"("enabled": true, "threshold": 2, "omega": 0.2, "planner": ")") + GetParam() +
        "\"";
    options.models = R"([{"kind": "constant_position", "position_psd": 0.0003}])";
    return room(options);
  }
  OwnChoice() : world(knowledge()), coordinator(world.background()) {
    EXPECT_TRUE(world.apply(cups_at({{1, 8}, {9, 1}}, kStart)).ok());
  }
  std::vector<Task> next(double seconds) {
    return coordinator.next(kStart + from_seconds(seconds), *world.belief(), {robot_at(1, 5)});
  }
  void end(const Task& task, VerificationResult::Outcome outcome, double seconds) {
    VerificationResult result;
    result.task = task.id;
    result.outcome = outcome;
    const auto checked = coordinator.check(result, kStart + from_seconds(seconds));
    ASSERT_TRUE(checked.ok()) << checked.error().text();
    coordinator.end(*checked);
  }

  World world;
  Coordinator coordinator;
};
INSTANTIATE_TEST_SUITE_P(Planners, OwnChoice, testing::Values("greedy", "lookahead"));

TEST_P(OwnChoice, WaitsUntilSomethingGains) {
  EXPECT_TRUE(next(0).empty());
  const auto issued = next(60);
  ASSERT_EQ(issued.size(), 1u);
  EXPECT_EQ(issued[0].object, "cup-1");
  EXPECT_FALSE(issued[0].triggered);
  EXPECT_GT(issued[0].gain_nat, 2);
  EXPECT_FALSE(issued[0].reason.empty());
  EXPECT_TRUE(next(61).empty());
}

TEST_P(OwnChoice, TriggersComeFirst) {
  ASSERT_TRUE(coordinator.add({}, "cup-2", "cup", kStart + 60 * kSecond).ok());
  const auto issued = next(60);
  ASSERT_EQ(issued.size(), 1u);
  EXPECT_EQ(issued[0].object, "cup-2");
  EXPECT_TRUE(issued[0].triggered);
}

TEST_P(OwnChoice, MakesWayForATrigger) {
  const auto own = next(60);
  ASSERT_EQ(own.size(), 1u);
  const std::string other = own[0].object == "cup-1" ? "cup-2" : "cup-1";
  ASSERT_TRUE(coordinator.add({}, other, "cup", kStart + 61 * kSecond).ok());
  const auto changed = next(61);
  ASSERT_EQ(changed.size(), 2u);
  EXPECT_EQ(changed[0].id, own[0].id);
  EXPECT_EQ(changed[0].state, Task::State::kCancelled);
  EXPECT_EQ(changed[1].object, other);
  EXPECT_EQ(changed[1].state, Task::State::kIssued);
  EXPECT_TRUE(next(62).empty()) << "a trigger's task makes way for nobody";
}

TEST_P(OwnChoice, WhatARobotHoldsIsNotLookedFor) {
  Event event;
  event.kind = Event::Kind::kGrasped;
  event.utime = kStart;
  event.object = "cup-1";
  ASSERT_TRUE(world.apply(event).ok());
  const auto issued = next(60);
  ASSERT_EQ(issued.size(), 1u);
  EXPECT_EQ(issued[0].object, "cup-2");
}

TEST_P(OwnChoice, WhatIsOccludedIsLeftAloneForAWhile) {
  const auto first = next(60);
  ASSERT_EQ(first.size(), 1u);
  ASSERT_EQ(first[0].object, "cup-1");
  end(first[0], VerificationResult::Outcome::kOccluded, 70);
  const auto second = next(71);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(second[0].object, "cup-2");
  end(second[0], VerificationResult::Outcome::kOccluded, 80);
  EXPECT_TRUE(next(81).empty());
  const auto third = next(131);  // the configured timeout of 60 s after the first
  ASSERT_EQ(third.size(), 1u);
  EXPECT_EQ(third[0].object, "cup-1");
}

}  // namespace
}  // namespace anchord
