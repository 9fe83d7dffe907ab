#include "tests/maintenance/small_home.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "knowledge/configuration.h"

namespace anchord {

Knowledge room(const RoomOptions& options) {
  const std::string text =
      R"({"world": {"dimensions": 2, "bounds": {"min": [0, 0], "max": [10, 10]}, "walls": )" +
      options.walls + R"(},
  "attributes": {"class": {"kind": "categorical", "symbols": ["cup"]}},
  "classes": {"cup": {"models": )" +
      options.models + R"(, "detection_probability": )" + std::to_string(options.p_d) +
      R"(, "extent": [0.1, 0.1, 0.1]}},
  "sensors": {"eye": {"view": {"type": "sector", "range": [0.4, 2], "bearing": [-3.141592653589793, 3.141592653589793]},
                      "noise": [0.01, 0, 0, 0.01],
                      "verification": {)" +
      options.verification + "}}" + options.more_sensors + R"(},
  "maintenance": {)" +
      options.maintenance + "}}";
  const Configuration configuration = parse_configuration(text);
  for (const auto& mistake : configuration.mistakes())
    std::fprintf(stderr, "%s\n", mistake.text().c_str());
  if (!configuration.ok()) std::abort();
  return configuration.knowledge();
}

Subject cup(const std::string& id, double x, double y, double variance, const Knowledge& knowledge,
            double psd, double p) {
  Gaussian position;
  position.mean = {x, y, 0};
  position.covariance(0, 0) = position.covariance(1, 1) = variance;
  return single_subject(id, position, psd, p, 0, knowledge);
}

Subject with_q(Subject subject, double q) {
  for (DetectionProbability& each : subject.detection_probability) each = q;
  return subject;
}

RobotPose robot_at(double x, double y, const std::string& name) {
  RobotPose robot;
  robot.robot = name;
  robot.pose.position = {x, y, 0};
  return robot;
}

Frame cups_at(const std::vector<std::array<double, 2>>& positions, Utime utime, double variance) {
  Frame frame;
  frame.utime = utime;
  frame.sensor = "eye";
  frame.view.emplace().type = View::Type::kWorld;
  for (const auto& position : positions) {
    Detection detection;
    detection.measurement =
        CartesianMeasurement{{position[0], position[1]}, {variance, 0, 0, variance}};
    detection.score = 1 - 1e-6;
    frame.detections.push_back(detection);
  }
  return frame;
}

ObjectBelief only_object(const World& world, double seconds) {
  auto all = read_objects(*world.belief(), kStart + from_seconds(seconds), 0, *world.background());
  EXPECT_EQ(all.size(), 1u);
  return all.front();
}

World with_a_cup_that_gets_lost(const std::string& tracked) {
  RoomOptions options;
  options.models = "[" + tracked + R"(, {"kind": "somewhere", "rate": 0.01}])";
  World world(room(options));
  EXPECT_TRUE(world.apply(cups_at({{5, 5}}, kStart)).ok());
  return world;
}

}  // namespace anchord
