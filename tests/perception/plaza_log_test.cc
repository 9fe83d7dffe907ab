#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "api/lcm_log.h"
#include "geometry/conversion.h"
#include "geometry/view.h"
#include "plaza.h"

namespace anchord {
namespace {

constexpr int kFrames = 795;  // of vtest.avi
constexpr Utime kStart = 1'700'000'000'000'000;

TEST(PlazaLog, HoldsAllFramesOfTheVideo) {
  std::ifstream file(project_file("data/plaza.lcm"), std::ios::binary);
  ASSERT_TRUE(file);
  LcmLogReader reader(file);
  std::size_t detections = 0;
  for (int i = 0; i < kFrames; ++i) {
    const auto message = reader.next_frame();
    ASSERT_TRUE(message) << message.error().text();
    ASSERT_TRUE(message->has_value());
    const Frame& frame = (*message)->frame;
    EXPECT_EQ(frame.utime, kStart + std::llround(1e6 * i / 7.0));
    EXPECT_EQ(frame.sensor, "camera");
    EXPECT_TRUE(MapView::place(frame.view.value(), frame.pose, 2));
    for (const Detection& detection : frame.detections) {
      const auto& measured = std::get<CartesianMeasurement>(detection.measurement);
      EXPECT_TRUE(to_map(measured, frame.pose, 2));
    }
    detections += frame.detections.size();
  }
  const auto end = reader.next_frame();
  ASSERT_TRUE(end) << end.error().text();
  EXPECT_FALSE(end->has_value());
  // The video holds 4,650 annotated people: a log with far fewer or more is of another detector.
  EXPECT_GT(detections, 4200U);
  EXPECT_LT(detections, 5100U);
}

}  // namespace
}  // namespace anchord
