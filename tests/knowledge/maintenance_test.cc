#include "knowledge/maintenance.h"

#include <gtest/gtest.h>

#include <string>

#include "knowledge/configuration.h"

namespace anchord {
namespace {

const std::string kWorld =
    R"("world": {"dimensions": 2, "bounds": {"min": [0, 0], "max": [6, 8]}},
       "attributes": {"class": {"kind": "categorical", "symbols": ["cup", "box"]}})";

Configuration with(const std::string& more) {
  return parse_configuration("{" + kWorld + ", " + more + "}");
}

/// "path: message" of the first mistake, or what is there instead.
std::string first_mistake(const std::string& more) {
  const Configuration configuration = with(more);
  return configuration.ok() ? "no mistake" : configuration.mistakes()[0].text();
}
void expect_mistake(const std::string& more, const std::string& path, const std::string& part) {
  const std::string text = first_mistake(more);
  EXPECT_EQ(text.substr(0, path.size() + 1), path + ":") << more;
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(MaintenanceReader, WithoutTheSectionTheDocumentedDefaultsHold) {
  const Configuration configuration = parse_configuration("{" + kWorld + "}");
  ASSERT_TRUE(configuration.ok());
  const Maintenance& m = configuration.knowledge().maintenance;
  EXPECT_EQ(m.planner, Maintenance::Planner::kGreedy);
  EXPECT_EQ(m.threshold, 1);
  EXPECT_EQ(m.omega, 0.75);
  EXPECT_EQ(m.gain_norm, 5);
  EXPECT_EQ(m.cost_scale, 10);  // the diagonal of 6 x 8 m
  EXPECT_EQ(m.speed, 0.5);
  EXPECT_EQ(m.step, 1);
  EXPECT_EQ(m.horizon, 4);
  EXPECT_EQ(m.timeout, 60);
  EXPECT_FALSE(m.enabled);
  ASSERT_EQ(m.actions.size(), 3u);  // thesis table 3.1
  EXPECT_EQ(m.actions[2].action, "release");
  EXPECT_EQ(m.actions[2].verify, Maintenance::Verify::kNothing);
}

TEST(MaintenanceReader, TakesEveryKey) {
  const Configuration configuration = with(R"("maintenance": {"planner": "lookahead",
    "threshold": 8, "omega": 2, "gain_norm": 4, "cost_scale": 3, "speed": 1, "step": 0.1,
    "clearance": 0.4, "horizon": 3, "timeout": 20, "enabled": true,
    "actions": [{"action": "water", "verify": "object"}]})");
  ASSERT_TRUE(configuration.ok()) << configuration.mistakes()[0].text();
  const Maintenance& m = configuration.knowledge().maintenance;
  EXPECT_EQ(m.planner, Maintenance::Planner::kLookahead);
  EXPECT_EQ(m.threshold, 8);
  EXPECT_EQ(m.omega, 2);
  EXPECT_EQ(m.gain_norm, 4);
  EXPECT_EQ(m.cost_scale, 3);
  EXPECT_EQ(m.speed, 1);
  EXPECT_EQ(m.step, 0.1);
  EXPECT_EQ(m.clearance, 0.4);
  EXPECT_EQ(m.horizon, 3);
  EXPECT_EQ(m.timeout, 20);
  EXPECT_TRUE(m.enabled);
  ASSERT_EQ(m.actions.size(), 1u);
  EXPECT_EQ(m.actions[0].action, "water");
}

TEST(MaintenanceReader, ASensorForTasksTakesItsOwnNoiseWhereNoneIsSaid) {
  const Configuration configuration = with(R"("sensors": {
    "default": {"view": {"type": "frustum", "hfov": 1, "range": [0.5, 4]},
                "noise": [0.1, 0, 0, 0.1]},
    "eye": {"verification": {"mount": {"position": [0.1, 0, 1], "orientation": [0, 0, 0, 1]},
            "moves_base": false, "cost": 0.3, "dwell": 2,
            "noise": {"cup": [0.2, 0, 0, 0.2]}}},
    "other": {}})");
  ASSERT_TRUE(configuration.ok()) << configuration.mistakes()[0].text();
  const Knowledge& knowledge = configuration.knowledge();
  EXPECT_FALSE(knowledge.sensor("other").verification);
  EXPECT_FALSE(knowledge.default_sensor.verification);
  const auto& verification = knowledge.sensor("eye").verification;
  ASSERT_TRUE(verification);
  EXPECT_EQ(verification->mount.position[2], 1);
  EXPECT_EQ(verification->mount.orientation[3], 1);
  EXPECT_FALSE(verification->moves_base);
  EXPECT_EQ(verification->cost, 0.3);
  EXPECT_EQ(verification->dwell, 2);
  EXPECT_EQ(verification->noise[0][0], 0.2);
  EXPECT_EQ(verification->noise[1][0], 0.1);
}

TEST(MaintenanceReader, MistakesAreNamedWithTheirPaths) {
  expect_mistake(R"("maintenance": {"planer": "greedy"})", "maintenance.planer",
                 "did you mean \"planner\"?");
  expect_mistake(R"("maintenance": {"planner": "greed"})", "maintenance.planner", "greedy");
  expect_mistake(R"("maintenance": {"omega": -1})", "maintenance.omega", "a number");
  expect_mistake(R"("maintenance": {"speed": 0})", "maintenance.speed", "a number");
  expect_mistake(R"("maintenance": {"horizon": 0})", "maintenance.horizon", "whole number");
  expect_mistake(R"("maintenance": {"actions": [{"action": "a"}]})",
                 "maintenance.actions[0].verify", "is missing");
  expect_mistake(R"("maintenance": {"actions": [{"action": "a", "verify": "it"}]})",
                 "maintenance.actions[0].verify", "it");
  expect_mistake(R"("maintenance": {"actions": [{"action": "a", "verify": "none"},
                                                {"action": "a", "verify": "none"}]})",
                 "maintenance.actions[1].action", "already");
}

TEST(MaintenanceReader, ASensorForTasksMustSeeAndMeasure) {
  expect_mistake(R"("sensors": {"eye": {"noise": [1, 0, 0, 1], "verification": {}}})",
                 "sensors.eye.verification", "view");
  expect_mistake(R"("sensors": {"eye": {"view": {"type": "world"}, "verification": {}}})",
                 "sensors.eye.verification.noise", "is missing");
  expect_mistake(R"("sensors": {"eye": {"view": {"type": "world"}, "verification":
                    {"noise": {"cup": [1, 0, 0, 1]}}}})",
                 "sensors.eye.verification.noise", "is missing");
  expect_mistake(R"("sensors": {"eye": {"view": {"type": "world"}, "verification":
                    {"noise": {"default": [1, 0, 0, -1]}}}})",
                 "sensors.eye.verification.noise.default", "positive definite");
  expect_mistake(R"("sensors": {"eye": {"view": {"type": "world"}, "noise": [1, 0, 0, 1],
                    "verification": {"mount": {"orientation": [1, 1, 0, 0]}}}})",
                 "sensors.eye.verification.mount.orientation", "norm 1");
  expect_mistake(R"("sensors": {"eye": {"view": {"type": "world"}, "noise": [1, 0, 0, 1],
                    "verification": {"dwel": 1}}})",
                 "sensors.eye.verification.dwel", "dwell");
}

}  // namespace
}  // namespace anchord
