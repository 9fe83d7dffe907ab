#include "perception/clothes.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "plaza.h"

namespace anchord {
namespace {

class ClothesTest : public testing::Test {
 protected:
  ClothesTest() : clothes_(plaza_settings().clothes) {
    const Camera camera(plaza_settings().camera);
    person_ = *stand(camera, camera.project({-10, -8, 0}), 1.74);
  }
  std::map<std::string, double> shares_of(const cv::Scalar& bgr) const {
    const cv::Mat frame(576, 768, CV_8UC3, bgr);
    const auto shares = clothes_.shares(frame, cv::Mat1f(frame.size(), 1.0F),
                                        cv::Mat1b::zeros(frame.size()), person_);
    std::map<std::string, double> named;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      named[clothes_.settings().colors[i].name] = shares[i];
    }
    return named;
  }

  ClothesColors clothes_;
  Silhouette person_;
};

TEST_F(ClothesTest, NamesPlainColors) {
  // Blue, green, red of the middle of what the jackets in the plaza's video show.
  EXPECT_DOUBLE_EQ(shares_of({35, 30, 170})["red"], 1);
  EXPECT_DOUBLE_EQ(shares_of({140, 100, 66})["blue"], 1);
  EXPECT_DOUBLE_EQ(shares_of({20, 20, 20})["black"], 1);
  EXPECT_DOUBLE_EQ(shares_of({110, 112, 115})["gray"], 1);
  EXPECT_DOUBLE_EQ(shares_of({235, 240, 238})["white"], 1);
  EXPECT_DOUBLE_EQ(shares_of({30, 50, 80})["brown"], 1);
}

TEST_F(ClothesTest, EveryPixelHasOneColor) {
  for (int b = 0; b < 256; b += 51) {
    for (int g = 0; g < 256; g += 51) {
      for (int r = 0; r < 256; r += 51) {
        double sum = 0;
        for (const auto& [name, share] : shares_of(cv::Scalar(b, g, r))) sum += share;
        EXPECT_NEAR(sum, 1, 1e-12) << b << ' ' << g << ' ' << r;  // rounding
      }
    }
  }
}

TEST_F(ClothesTest, SaysNothingWhenHidden) {
  const cv::Mat frame(576, 768, CV_8UC3, cv::Scalar(20, 20, 200));
  const cv::Mat1f all(frame.size(), 1.0F);
  EXPECT_TRUE(clothes_.shares(frame, all, cv::Mat1b(frame.size(), uchar{255}), person_).empty());
  EXPECT_TRUE(clothes_.shares(frame, all * 0, cv::Mat1b::zeros(frame.size()), person_).empty());
}

/// The belief that equal reports add up to, the prior being uniform and a report's missing
/// symbols sharing what is left.
double belief_after(const SymbolReport& report, int times, std::size_t symbols) {
  double named = 0;
  for (const auto& [name, p] : report.probabilities) named += p;
  const double rest = (1 - named) / static_cast<double>(symbols - report.probabilities.size());
  double sum = static_cast<double>(symbols - report.probabilities.size()) * std::pow(rest, times);
  double best = 0;
  for (const auto& [name, p] : report.probabilities) {
    sum += std::pow(p, times);
    best = std::max(best, std::pow(p, times));
  }
  return best / sum;
}

TEST_F(ClothesTest, ReportsAreModest) {
  const std::size_t n = clothes_.settings().colors.size();
  std::vector<double> mixed(n, 0.0);  // a jacket of two colors
  mixed[0] = 0.55;
  mixed[1] = 0.45;
  const SymbolReport report = clothes_.report(mixed);
  double sum = 0;
  for (const auto& [name, p] : report.probabilities) sum += p;
  EXPECT_LE(sum, 1);
  EXPECT_LT(belief_after(report, 1, n), 0.2);
  // Seven seconds of the same pixels must not turn 55 % into certainty.
  EXPECT_LT(belief_after(report, 50, n), 0.75);

  std::vector<double> plain(n, 0.0);
  plain[0] = 1;
  EXPECT_GT(belief_after(clothes_.report(plain), 50, n), 0.99);
}

TEST(NamedColor, HuesGoThroughRed) {
  const NamedColor red{"red", {330, 15}, {0.4, 1}, {0.2, 1}};
  EXPECT_TRUE(red.holds(350, 0.9, 0.9));
  EXPECT_TRUE(red.holds(5, 0.9, 0.9));
  EXPECT_FALSE(red.holds(120, 0.9, 0.9));
  EXPECT_FALSE(red.holds(5, 0.1, 0.9));
}

}  // namespace
}  // namespace anchord
