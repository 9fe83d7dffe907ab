#include "daemon/statistics.h"

#include <gtest/gtest.h>

namespace anchord {
namespace {

TEST(SequenceGaps, CountWhatIsMissing) {
  SequenceGaps gaps;
  EXPECT_EQ(gaps.missing("", "kinect", 7), 0u) << "nothing is known of what came before";
  EXPECT_EQ(gaps.missing("", "kinect", 8), 0u);
  EXPECT_EQ(gaps.missing("", "kinect", 12), 3u);
  EXPECT_EQ(gaps.missing("", "laser", 1), 0u) << "each sensor counts for itself";
  EXPECT_EQ(gaps.missing("", "kinect", 1), 0u) << "the publisher began anew";
  EXPECT_EQ(gaps.missing("", "kinect", 0), 0u) << "not numbered";
}

TEST(UpdateTimes, QuantilesAreOfTheLatest) {
  UpdateTimes times;
  for (int i = 0; i < 5000; ++i) times.add(1);
  for (int i = 1; i <= 4096; ++i) times.add(i * 1e-6);
  const auto summary = times.summary();
  EXPECT_EQ(summary.count, 9096u);
  EXPECT_NEAR(summary.median_us, 2048, 1);  // of 1 .. 4096
  EXPECT_NEAR(summary.max_us, 4096, 1e-6);
}

}  // namespace
}  // namespace anchord
