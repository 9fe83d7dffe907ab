#include <gtest/gtest.h>

#include "knowledge/configuration.h"

namespace anchord {
namespace {

TEST(Motion, ArrivalsMayMoveBeforeTheyAreSeen) {
  const auto configuration = parse_configuration(R"({
    "world": {"dimensions": 2, "bounds": {"min": [-10, -10], "max": [10, 10]}},
    "classes": {"default": {"arrivals": [
      {"mean": [4, -6], "covariance": [2, 1, 1, 3], "rate": 0.1},
      {"mean": [4, -6], "covariance": [2, 1, 1, 3], "rate": 0.1, "moves": false},
      {"mean": [4, -6], "covariance": [2, 1, 1, 3], "rate": 0.1, "moves": true},
      {"mean": [4, -6], "covariance": [2, 1, 1, 3], "rate": 0.1, "moves": true, "at_start": 0.5,
       "velocity": [1, -2], "velocity_covariance": [0.5, 0.1, 0.1, 0.25]}]}}})");
  ASSERT_TRUE(configuration.ok());
  const auto& arrivals = configuration.knowledge().classes[0].arrivals;
  ASSERT_EQ(arrivals.size(), 4u);
  EXPECT_FALSE(arrivals[0].motion || arrivals[1].motion);
  ASSERT_TRUE(arrivals[2].motion && arrivals[3].motion);
  EXPECT_EQ(arrivals[2].motion->velocity, Eigen::Vector3d::Zero());
  EXPECT_FALSE(arrivals[2].motion->velocity_covariance);
  EXPECT_EQ(arrivals[2].motion->at_start, 0);
  EXPECT_EQ(arrivals[3].motion->velocity, Eigen::Vector3d(1, -2, 0));
  EXPECT_EQ((*arrivals[3].motion->velocity_covariance)(1, 1), 0.25);
  EXPECT_EQ((*arrivals[3].motion->velocity_covariance)(0, 1), 0.1);
  EXPECT_EQ(arrivals[3].motion->at_start, 0.5);
}

TEST(Motion, MotionInHeightIsAShareOfThatInThePlane) {
  const auto configuration = parse_configuration(R"({
    "world": {"bounds": {"min": [0, 0, 0], "max": [10, 8, 3]}},
    "classes": {"object": {"models": [
      {"kind": "constant_velocity", "acceleration_psd": 0.5, "initial_velocity_variance": 4,
       "vertical": 0.01},
      {"kind": "constant_position", "position_psd": 0.2}]}}})");
  ASSERT_TRUE(configuration.ok());
  const auto& models = configuration.knowledge().classes[0].models;
  EXPECT_EQ(models[0].psd, ByAxis(0.5, 0.005));
  EXPECT_EQ(models[0].initial_velocity_variance, ByAxis(4, 0.04));
  EXPECT_EQ(models[1].psd, ByAxis(0.2, 0.2));
}

}  // namespace
}  // namespace anchord
