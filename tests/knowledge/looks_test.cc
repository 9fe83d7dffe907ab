// What is false, by what it looks like and is reported as.

#include <gtest/gtest.h>

#include <string>

#include "knowledge/configuration.h"
#include "tests/knowledge/one_mistake.h"

namespace anchord {
namespace {

Configuration read(const std::string& more) {
  return parse_configuration(R"({"world": {"bounds": {"min": [0, 0, 0], "max": [10, 8, 3]}},
    "attributes": {"class": {"kind": "categorical", "symbols": ["cup", "box", "ant"]}}, )" +
                             more + "}");
}

TEST(Looks, AreReadByClass) {
  const Configuration configuration = read(
      R"("classes": {"ant": {"phantom": true, "looks_like": "box"}},
    "sensors": {
      "default": {"clutter_density": {"cup": 0.3, "box": 0.1}, "real_share": 0.4},
      "a": {"real_share": {"cup": 0.7}, "score_memory": {"box": {"share": 0.5}},
            "score_calibration": {"cup": [1, 2, 3]}},
      "b": {"clutter_density": 2, "score_memory": {"share": 0.6, "seconds": 3}}})");
  ASSERT_TRUE(configuration.ok()) << configuration.mistakes()[0].text();
  const Knowledge& knowledge = configuration.knowledge();
  const int cup = knowledge.find_class("cup"), box = knowledge.find_class("box");
  EXPECT_EQ(knowledge.classes[knowledge.find_class("ant")].looks_like, box);
  EXPECT_EQ(knowledge.classes[cup].looks_like, -1);
  const Sensor &a = knowledge.sensor("a"), &b = knowledge.sensor("b");
  EXPECT_DOUBLE_EQ(a.clutter_density, 0.4);
  EXPECT_DOUBLE_EQ(a.clutter_looks[cup], 0.75);
  EXPECT_DOUBLE_EQ(a.clutter_looks[box], 0.25);
  EXPECT_EQ(b.clutter_density, 2);
  EXPECT_TRUE(b.clutter_looks.empty());
  EXPECT_EQ(a.real_share.at(cup), 0.7);
  EXPECT_EQ(a.real_share.at(box), 0.4);
  EXPECT_EQ(a.real_share.at(-1), 0.4);
  EXPECT_EQ(a.score_memory.at(box).share, 0.5);
  EXPECT_EQ(a.score_memory.at(cup).share, 0);
  EXPECT_EQ(a.score_calibration.at(cup).per_m, 3);
  EXPECT_EQ(a.score_calibration.at(box).b, 1);
  EXPECT_EQ(b.score_memory.at(cup).seconds, 3);
}

using Case = OneMistake;

class MistakenLook : public testing::TestWithParam<Case> {};

TEST_P(MistakenLook, IsNotedWithItsPath) { expect_noted(read(GetParam().more), GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Looks, MistakenLook,
    testing::Values(Case{R"("sensors": {"a": {"real_share": {"cup": 1}}})",
                         "sensors.a.real_share.cup", "not 1"},
                    Case{R"("sensors": {"a": {"real_share": [0.5]}})", "sensors.a.real_share",
                         "for each class"},
                    Case{R"("sensors": {"a": {"score_calibration": {"cup": [0, -1, 2]}}})",
                         "sensors.a.score_calibration.cup", "b above 0"},
                    Case{R"("sensors": {"a": {"score_memory": {"cup": {"share": 1}}}})",
                         "sensors.a.score_memory.cup.share", "not 1"},
                    Case{R"("sensors": {"a": {"clutter_density": {"cup": 0}}})",
                         "sensors.a.clutter_density.cup", "above 0"},
                    Case{R"("sensors": {"a": {"clutter_density": {"cupp": 1}}})",
                         "sensors.a.clutter_density.cupp", "did you mean \"cup\"?"},
                    Case{R"("sensors": {"a": {"clutter_density": {"default": 1}}})",
                         "sensors.a.clutter_density.default", "no class"},
                    Case{R"("sensors": {"a": {"clutter_density": {}}})",
                         "sensors.a.clutter_density", "must name a class"},
                    Case{R"("classes": {"cup": {"phantom": true}},
            "sensors": {"a": {"clutter_density": {"cup": 1}}})",
                         "sensors.a.clutter_density.cup", "is a phantom"},
                    Case{R"("classes": {"cup": {"looks_like": "box"}})", "classes.cup.looks_like",
                         "is for a phantom"},
                    Case{R"("classes": {"cup": {"phantom": true, "looks_like": "cup"}})",
                         "classes.cup.looks_like", "is a phantom"},
                    Case{R"("classes": {"cup": {"phantom": true, "looks_like": "boxx"}})",
                         "classes.cup.looks_like", "did you mean \"box\"?"},
                    Case{R"("classes": {"default": {"looks_like": "cup"}})",
                         "classes.default.looks_like", "by name"}));

}  // namespace
}  // namespace anchord
