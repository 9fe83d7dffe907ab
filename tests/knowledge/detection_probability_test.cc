#include <gtest/gtest.h>

#include <cmath>

#include "knowledge/configuration.h"
#include "tests/knowledge/one_mistake.h"

namespace anchord {
namespace {

Configuration with(const std::string& more) {
  return parse_configuration(R"({"world": {"bounds": {"min": [0, 0, 0], "max": [10, 8, 3]}},
    "attributes": {"class": {"kind": "categorical", "symbols": ["cup", "box", "ant"]}}, )" +
                             more + "}");
}

TEST(DetectionProbability, MayDependOnTheDistance) {
  const Configuration configuration = with(R"(
    "classes": {"default": {"detection_probability": [0.9, -0.1]},
                "ant": {"detection_probability": 0.2}},
    "sensors": {"a": {"detection_probability": {"cup": [0.8, -0.5], "default": [0.5, 0.01]}},
                "b": {"detection_probability": [0.6, -1000]}})");
  ASSERT_TRUE(configuration.ok()) << configuration.mistakes()[0].text();
  const Knowledge& knowledge = configuration.knowledge();
  using P = std::vector<DetectionProbability>;  // of cup, box, ant
  EXPECT_EQ(knowledge.default_sensor.detection_probability, (P{{0.9, -0.1}, {0.9, -0.1}, 0.2}));
  EXPECT_EQ(knowledge.sensor("a").detection_probability,
            (P{{0.8, -0.5}, {0.5, 0.01}, {0.5, 0.01}}));
  const DetectionProbability &cup = knowledge.sensor("a").detection_probability[0],
                             &step = knowledge.sensor("b").detection_probability[0];
  constexpr double kRounding = 1e-15;
  EXPECT_NEAR(cup.at(0), 0.8, kRounding);
  EXPECT_NEAR(cup.at(2), 4 * std::exp(-1) / (1 + 4 * std::exp(-1)), kRounding);  // odds 4 to 1
  EXPECT_EQ(step.at(1e8), 1e-6);
  EXPECT_EQ(DetectionProbability(0.6, 1000).at(1e8), 1 - 1e-6);
  EXPECT_EQ(knowledge.classes[2].detection_probability.at(1e8), 0.2);
}

class MistakenDistance : public testing::TestWithParam<OneMistake> {};

TEST_P(MistakenDistance, IsNotedWithItsPath) { expect_noted(with(GetParam().more), GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    ByDistance, MistakenDistance,
    testing::Values(OneMistake{R"("sensors": {"a": {"detection_probability": {"cup": [0, -0.1]}}})",
                               "sensors.a.detection_probability.cup", "p above 0 and below 1"},
                    OneMistake{
                        R"("sensors": {"a": {"detection_probability": {"cup": [0.9, -2000]}}})",
                        "sensors.a.detection_probability.cup", "c from -1000 to 1000"},
                    OneMistake{R"("classes": {"cup": {"detection_probability": [0.9, "far"]}})",
                               "classes.cup.detection_probability", "a number, or [p, c]"}));

}  // namespace
}  // namespace anchord
