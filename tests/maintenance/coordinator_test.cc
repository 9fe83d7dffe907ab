#include "maintenance/coordinator.h"

#include <gtest/gtest.h>

#include "tests/maintenance/small_home.h"

namespace anchord {
namespace {

constexpr Utime kSecond = 1'000'000;

/// Two cups, cup-1 at (2, 2) and cup-2 at (8, 8), and a coordinator that only serves triggers.
class Triggers : public testing::Test {
 protected:
  Triggers() : world(room()), coordinator(world.background()) {
    EXPECT_TRUE(world.apply(cups_at({{2, 2}, {8, 8}}, kStart)).ok());
  }

  Result<std::optional<Task>> add(const std::string& object, std::int64_t tag,
                                  const Trigger& more = {}) {
    Trigger trigger = more;
    trigger.object = object;
    trigger.tag = tag;
    return coordinator.add(trigger, object, "cup", kStart);
  }
  std::int64_t id(const std::string& object) { return add(object, 0).value()->id; }
  std::vector<Task> next(Utime now = kStart,
                         const std::vector<RobotPose>& robots = {robot_at(5, 5)}) {
    return coordinator.next(now, *world.belief(), robots);
  }
  VerificationResult result(std::int64_t task, VerificationResult::Outcome outcome) {
    VerificationResult r;
    r.task = task;
    r.outcome = outcome;
    r.utime = kStart + kSecond;
    if (outcome == VerificationResult::Outcome::kFound) r.frame = cups_at({{2, 2}}, r.utime);
    return r;
  }

  World world;
  Coordinator coordinator;
};
using Outcome = VerificationResult::Outcome;

TEST_F(Triggers, AreServedInTheOrderOfTheirComing) {
  const std::int64_t first = id("cup-2"), second = id("cup-1");
  const auto issued = next();
  ASSERT_EQ(issued.size(), 1u);  // one robot, one task
  EXPECT_EQ(issued[0].id, first);
  EXPECT_EQ(issued[0].state, Task::State::kIssued);
  EXPECT_EQ(issued[0].robot, "pip");
  EXPECT_EQ(issued[0].sensor, "eye");
  EXPECT_EQ(issued[0].object_class, "cup");
  EXPECT_TRUE(issued[0].viewpoint);
  ASSERT_EQ(issued[0].regions.size(), 1u);
  EXPECT_NEAR(issued[0].regions[0].center[0], 8, 1e-6);
  EXPECT_TRUE(next().empty());  // the robot has its task
  const auto end = coordinator.check(result(first, Outcome::kOccluded), kStart + kSecond);
  ASSERT_TRUE(end.ok());
  coordinator.end(*end);
  const auto after = next(kStart + kSecond);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_EQ(after[0].id, second);
}

TEST_F(Triggers, TwoRobotsTakeOneEachAndANamedOneItsOwn) {
  Trigger for_pop;
  for_pop.robot = "pop";
  const std::int64_t first = add("cup-1", 1, for_pop).value()->id;
  const std::int64_t second = id("cup-2");
  const auto issued = next(kStart, {robot_at(5, 5, "pip"), robot_at(1, 1, "pop")});
  ASSERT_EQ(issued.size(), 2u);
  EXPECT_EQ(issued[0].id, first);
  EXPECT_EQ(issued[0].robot, "pop");
  EXPECT_EQ(issued[1].id, second);
  EXPECT_EQ(issued[1].robot, "pip");
}

TEST_F(Triggers, WithoutAPoseATaskHasNoViewpoint) {
  id("cup-1");
  const auto issued = next(kStart, {});
  ASSERT_EQ(issued.size(), 1u);
  EXPECT_FALSE(issued[0].viewpoint);
  id("cup-2");
  EXPECT_TRUE(next(kStart, {}).empty());
}

TEST_F(Triggers, ForTheSameObjectAreJoinedUnlessAskedOtherwise) {
  Trigger late;
  late.timeout_s = 500;
  const Task first = *add("cup-1", 7).value();
  const Task joined = *add("cup-1", 8, late).value();
  EXPECT_EQ(joined.id, first.id);
  EXPECT_EQ(joined.tags, (std::vector<std::int64_t>{7, 8}));
  EXPECT_EQ(joined.deadline, kStart + 500 * kSecond);
  Trigger alone;
  alone.alone = true;
  EXPECT_NE(add("cup-1", 9, alone).value()->id, first.id);
  Trigger elsewhere;
  elsewhere.robot = "pop";
  EXPECT_NE(add("cup-1", 10, elsewhere).value()->id, first.id);
  EXPECT_EQ(coordinator.tasks().size(), 3u);
}

TEST_F(Triggers, ActionsAskForWhatTheTableSays) {
  Trigger grab, release, dance;
  grab.action = "grab";
  release.action = "release";
  dance.action = "dance";
  EXPECT_EQ(add("cup-1", 1, grab).value()->action, "grab");
  EXPECT_FALSE(add("cup-1", 2, release).value());
  const auto refused = add("cup-1", 3, dance);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().field, "action");
}

TEST_F(Triggers, WrongOnesAreRefusedByField) {
  Trigger nose, never;
  nose.sensor = "nose";
  never.timeout_s = -1;
  EXPECT_EQ(add("cup-1", 1, nose).error().field, "sensor");
  EXPECT_EQ(add("cup-1", 1, never).error().field, "timeout");
  never.timeout_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(add("cup-1", 1, never).error().field, "timeout");
  EXPECT_TRUE(coordinator.tasks().empty());
}

TEST_F(Triggers, AFloodIsRefusedAndTheRestServed) {
  Trigger alone;
  alone.alone = true;
  std::size_t accepted = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto task = add("cup-1", i, alone);
    accepted += task.ok();
    if (!task.ok()) {
      EXPECT_EQ(task.error().code, ErrorCode::kUnavailable);
    }
  }
  EXPECT_EQ(accepted, Coordinator::kMaxActive);
  const auto issued = next();
  ASSERT_EQ(issued.size(), 1u);
  EXPECT_FALSE(add("cup-2", 0).ok());
  ASSERT_TRUE(coordinator.cancel(issued[0].id, kStart).ok());
  EXPECT_TRUE(add("cup-2", 0).ok());
  // Joining takes no place, but a task has so many tags and no more.
  for (std::size_t i = 0; i < 10 * kMaxTags; ++i) (void)add("cup-1", 5);
  for (const Task& task : coordinator.tasks()) EXPECT_LE(task.tags.size(), kMaxTags);
}

TEST_F(Triggers, EndedTasksAreKeptButNotForEver) {
  for (std::size_t i = 0; i < Coordinator::kMaxEnded + 10; ++i)
    ASSERT_TRUE(coordinator.cancel(id("cup-1"), kStart).ok());
  EXPECT_EQ(coordinator.tasks().size(), Coordinator::kMaxEnded);
  EXPECT_EQ(coordinator.find(1), nullptr);
  EXPECT_EQ(coordinator.find(11)->state, Task::State::kCancelled);
}

TEST_F(Triggers, NothingChangesATaskWhoseResultIsOnItsWayToTheLog) {
  const std::int64_t task = id("cup-1");
  ASSERT_EQ(next().size(), 1u);
  const auto end = coordinator.check(result(task, Outcome::kFound), kStart + kSecond);
  ASSERT_TRUE(end.ok());
  coordinator.take_in_hand(task);
  EXPECT_EQ(coordinator.cancel(task, kStart + kSecond).error().code, ErrorCode::kConflict);
  EXPECT_EQ(coordinator.check(result(task, Outcome::kFound), kStart + kSecond).error().code,
            ErrorCode::kConflict);
  EXPECT_TRUE(coordinator.expire(kStart + 100'000 * kSecond).empty());
  EXPECT_NE(id("cup-1"), task) << "not joined";
  coordinator.end(*end);
  EXPECT_EQ(coordinator.find(task)->state, Task::State::kFound);
}

TEST_F(Triggers, OfTwoFreeRobotsTheOneThatLooksBestIsSent) {
  (void)id("cup-2");  // at (8, 8)
  const auto issued = next(kStart, {robot_at(1, 1, "far"), robot_at(7, 7, "near")});
  ASSERT_EQ(issued.size(), 1u);
  EXPECT_EQ(issued[0].robot, "near");
}

TEST_F(Triggers, CancellingEndsATaskOnce) {
  const std::int64_t task = id("cup-1");
  ASSERT_EQ(next().size(), 1u);
  const auto cancelled = coordinator.cancel(task, kStart + kSecond);
  ASSERT_TRUE(cancelled.ok());
  EXPECT_EQ(cancelled->state, Task::State::kCancelled);
  EXPECT_EQ(cancelled->ended, kStart + kSecond);
  EXPECT_EQ(coordinator.cancel(task, kStart).error().code, ErrorCode::kConflict);
  EXPECT_EQ(coordinator.cancel(99, kStart).error().code, ErrorCode::kUnknown);
  EXPECT_EQ(coordinator.check(result(task, Outcome::kFound), kStart).error().code,
            ErrorCode::kConflict);
}

TEST_F(Triggers, ExpireAtTheirDeadline) {
  const std::int64_t task = id("cup-1");
  ASSERT_EQ(next().size(), 1u);
  EXPECT_TRUE(coordinator.expire(kStart + 60 * kSecond - 1).empty());
  const auto ended = coordinator.expire(kStart + 60 * kSecond);
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].id, task);
  EXPECT_EQ(ended[0].state, Task::State::kExpired);
  EXPECT_EQ(coordinator.check(result(task, Outcome::kFound), kStart + 61 * kSecond).error().code,
            ErrorCode::kConflict);
  id("cup-2");
  EXPECT_EQ(next(kStart + kSecond).size(), 1u);  // the robot is free again
}

TEST_F(Triggers, AResultAfterTheDeadlineIsRefusedEvenBeforeItWasNoted) {
  const std::int64_t task = id("cup-1");
  ASSERT_EQ(next().size(), 1u);
  EXPECT_EQ(coordinator.check(result(task, Outcome::kFound), kStart + 60 * kSecond).error().code,
            ErrorCode::kConflict);
}

TEST_F(Triggers, FoundGivesAFrameThatNamesTheObject) {
  const std::int64_t task = id("cup-1");
  EXPECT_EQ(coordinator.check(result(task, Outcome::kFound), kStart).error().code,
            ErrorCode::kConflict);  // waits still
  ASSERT_EQ(next().size(), 1u);
  const auto end = coordinator.check(result(task, Outcome::kFound), kStart + kSecond);
  ASSERT_TRUE(end.ok());
  ASSERT_TRUE(end->frame);
  EXPECT_EQ(end->frame->detections.at(0).object, "cup-1");
  EXPECT_EQ(end->task.state, Task::State::kFound);
  EXPECT_EQ(coordinator.find(task)->state, Task::State::kIssued);  // nothing has changed yet
  coordinator.end(*end);
  EXPECT_EQ(*coordinator.find(task), end->task);
  EXPECT_EQ(coordinator.check(result(task, Outcome::kFound), kStart).error().code,
            ErrorCode::kConflict);
  EXPECT_EQ(coordinator.check(result(99, Outcome::kFound), kStart).error().code,
            ErrorCode::kUnknown);
}

TEST_F(Triggers, AFoundResultMustBeOneDetectionOfTheObject) {
  const std::int64_t task = id("cup-1");
  ASSERT_EQ(next().size(), 1u);
  VerificationResult r = result(task, Outcome::kFound);
  r.frame->detections[0].object = "cup-2";
  EXPECT_EQ(coordinator.check(r, kStart).error().field, "frame.detections[0].object");
  r.frame->detections.clear();
  EXPECT_EQ(coordinator.check(r, kStart).error().field, "frame.detections");
  r.frame.reset();
  EXPECT_EQ(coordinator.check(r, kStart).error().field, "frame");
}

TEST_F(Triggers, MissingGivesAnEventWithTheRegionsAndOccludedNothing) {
  const std::int64_t task = id("cup-1");
  const auto issued = next();
  ASSERT_EQ(issued.size(), 1u);
  const auto missing = coordinator.check(result(task, Outcome::kMissing), kStart + kSecond);
  ASSERT_TRUE(missing.ok());
  ASSERT_TRUE(missing->event);
  EXPECT_EQ(missing->event->kind, Event::Kind::kMissing);
  EXPECT_EQ(missing->event->object, "cup-1");
  EXPECT_EQ(missing->event->sensor, "eye");
  EXPECT_EQ(missing->event->robot, "pip");
  EXPECT_EQ(missing->event->utime, kStart + kSecond);
  EXPECT_EQ(missing->event->regions, issued[0].regions);
  VerificationResult timeless = result(task, Outcome::kMissing);
  timeless.utime = 0;
  EXPECT_EQ(coordinator.check(timeless, kStart).error().field, "utime");
  const auto occluded = coordinator.check(result(task, Outcome::kOccluded), kStart + kSecond);
  ASSERT_TRUE(occluded.ok());
  EXPECT_FALSE(occluded->event || occluded->frame);
}

TEST_F(Triggers, AnObjectThatIsGoneCancelsItsTask) {
  id("cup-77");
  const auto changed = next();
  ASSERT_EQ(changed.size(), 1u);
  EXPECT_EQ(changed[0].state, Task::State::kCancelled);
}

TEST_F(Triggers, ARestartInTheMiddleOfATaskChangesNothing) {
  const std::int64_t first = id("cup-1"), second = id("cup-2");
  ASSERT_EQ(next().size(), 1u);
  ASSERT_TRUE(coordinator
                  .cancel(add("cup-2", 1,
                              [] {
                                Trigger alone;
                                alone.alone = true;
                                return alone;
                              }())
                              .value()
                              ->id,
                          kStart)
                  .ok());
  Coordinator again(world.background());
  again.restore(coordinator.tasks());
  EXPECT_EQ(again.tasks(), coordinator.tasks());
  EXPECT_TRUE(again.next(kStart, *world.belief(), {robot_at(5, 5)}).empty());
  const auto end = again.check(result(first, Outcome::kFound), kStart + kSecond);
  ASSERT_TRUE(end.ok());
  again.end(*end);
  const auto issued = again.next(kStart + kSecond, *world.belief(), {robot_at(5, 5)});
  ASSERT_EQ(issued.size(), 1u);
  EXPECT_EQ(issued[0].id, second);
  EXPECT_EQ(again.expire(kStart + 60 * kSecond).size(), 1u);
  EXPECT_EQ(again.add({}, "cup-1", "cup", kStart).value()->id, 4);  // ids go on
}

}  // namespace
}  // namespace anchord
