#include "task_list.h"

#include <gtest/gtest.h>

#include "tasks.h"

namespace anchord {
namespace {

Sighting absent() {
  Sighting sighting;
  sighting.sight = Sighting::Sight::kAbsent;
  return sighting;
}

TEST(TaskList, TakesIssuedTasksOfItsSensor) {
  TaskList list("", "camera", 2, 3);
  Task queued = ball_task(1), others = ball_task(2), robots = ball_task(3);
  queued.state = Task::State::kQueued;
  others.sensor = "kinect";
  robots.robot = "amigo";
  for (const Task& task : {queued, others, robots, ball_task(4)}) EXPECT_TRUE(list.add(task));
  const auto open = list.open(kNow);
  ASSERT_EQ(open.size(), 1U);
  EXPECT_EQ(open[0], ball_task(4));
}

TEST(TaskList, LetsGoWhatIsNoLongerAsked) {
  TaskList list("", "camera", 2, 3);
  EXPECT_TRUE(list.add(ball_task(1)));
  EXPECT_TRUE(list.add(ball_task(2)));
  Task cancelled = ball_task(1);
  cancelled.state = Task::State::kCancelled;
  EXPECT_TRUE(list.add(cancelled));
  ASSERT_EQ(list.open(kNow).size(), 1U);
  EXPECT_TRUE(list.open(kNow + 2'000'001).empty());  // past the deadline
  EXPECT_TRUE(list.open(kNow).empty());              // and gone
}

TEST(TaskList, UsesNoPictureFromBeforeTheTask) {
  TaskList list("", "camera", 2, 3);
  EXPECT_TRUE(list.add(ball_task(1)));
  EXPECT_TRUE(list.open(kNow - 1).empty());
  EXPECT_EQ(list.open(kNow).size(), 1U);
}

TEST(TaskList, RefusesWhatCannotBeLookedFor) {
  TaskList list("", "camera", 2, 3);
  Task bad = ball_task(1);
  bad.regions[0].radius = -1;
  EXPECT_FALSE(list.add(bad));
  EXPECT_TRUE(list.open(kNow).empty());
}

TEST(TaskList, CountsLooksThoughToldAgain) {
  TaskList list("", "camera", 2, 3);
  EXPECT_TRUE(list.add(ball_task(1)));
  EXPECT_FALSE(list.looked(1, absent()));
  EXPECT_FALSE(list.looked(1, absent()));
  EXPECT_TRUE(list.add(ball_task(1)));
  EXPECT_EQ(list.looked(1, absent()), VerificationResult::Outcome::kMissing);
  EXPECT_TRUE(list.open(kNow).empty());
  EXPECT_FALSE(list.looked(1, absent()));  // nobody asks any more
}

TEST(TaskList, IsBounded) {
  TaskList list("", "camera", 2, 3);
  for (int i = 1; i <= 100; ++i) EXPECT_TRUE(list.add(ball_task(i)));
  const auto open = list.open(kNow);
  ASSERT_EQ(open.size(), TaskList::kMostTasks);
  EXPECT_EQ(open.back().id, 100);
}

}  // namespace
}  // namespace anchord
