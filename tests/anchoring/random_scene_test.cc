#include "tests/anchoring/random_scene.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <random>
#include <variant>
#include <vector>

#include "tests/anchoring/enumeration.h"

namespace anchord::enumeration {
namespace {

constexpr double kRounding = 1e-12;  // sums of at most a few thousand probabilities

TEST(RandomScene, WorldsAreCountedAndOriginsSumToOne) {
  std::mt19937_64 random(20140601);
  for (int n = 0; n < 60; ++n) {
    Variety variety = random_variety(random);
    variety.max_worlds = 2000;
    const Scene scene = random_scene(random, variety);
    std::vector<std::size_t> detections;
    for (const Frame& f : scene.frames) detections.push_back(f.detections.size());
    const EnumeratedBelief belief = enumerate(scene.knowledge, scene.frames);
    EXPECT_LE(static_cast<double>(belief.worlds), count_worlds(detections, variety.departures));
    EXPECT_GT(belief.evidence, 0);
    for (std::size_t t = 0; t < belief.origins.size(); ++t) {
      for (std::size_t d = 0; d < belief.origins[t].size(); ++d) {
        const Origin& origin = belief.origins[t][d];
        double sum = origin.p_new + origin.p_clutter;
        for (const auto& [key, p] : origin.objects) sum += p;
        EXPECT_NEAR(sum, 1, kRounding);
        const EnumeratedObject& object = belief.objects.at({t, d});
        EXPECT_LE(object.p_exists, origin.p_new + kRounding);
        if (object.p_exists == 0) continue;
        double classes = 0, models = 0;
        for (const double p : object.classes) classes += p;
        for (const auto& of_class : object.models)
          for (const double p : of_class) models += p;
        EXPECT_NEAR(classes, 1, kRounding);
        EXPECT_NEAR(models, 1, kRounding);
        EXPECT_TRUE(object.mean.allFinite() && object.covariance.allFinite());
      }
    }
  }
}

TEST(RandomScene, PlainScenesReachTheCount) {
  std::mt19937_64 random(7);
  for (int n = 0; n < 20; ++n) {
    Variety variety;
    variety.departures = n % 2 == 1;
    variety.max_worlds = 500;
    Scene scene = random_scene(random, variety);
    if (variety.departures) scene.knowledge.classes[0].departure_rate = 0.1;
    std::vector<std::size_t> detections;
    for (const Frame& f : scene.frames) detections.push_back(f.detections.size());
    EXPECT_EQ(static_cast<double>(enumerate(scene.knowledge, scene.frames).worlds),
              count_worlds(detections, variety.departures));
  }
}

TEST(RandomScene, FramesAndTheirArrivalAreLegal) {
  std::mt19937_64 random(3);
  for (int n = 0; n < 300; ++n) {
    Variety variety = random_variety(random);
    const Scene scene = random_scene(random, variety);
    ASSERT_EQ(scene.arrival.size(), scene.frames.size());
    Utime latest = 0;
    for (std::size_t i = 0; i < scene.arrival.size(); ++i) {
      const Frame& arrived = scene.frames[scene.arrival[i]];
      EXPECT_LE(seconds_between(arrived.utime, latest), scene.knowledge.max_lateness);
      latest = std::max(latest, arrived.utime);
      for (std::size_t j = 0; j < i; ++j) {
        const Frame& before = scene.frames[scene.arrival[j]];
        if (before.sensor == arrived.sensor) {
          EXPECT_LT(before.utime, arrived.utime);
        }
        if (before.utime == arrived.utime) {
          EXPECT_LT(scene.arrival[j], scene.arrival[i]);
        }
      }
      if (i > 0) {
        EXPECT_LE(scene.frames[i - 1].utime, scene.frames[i].utime);
      }
      for (const Detection& detection : arrived.detections) {
        const int d = scene.knowledge.dims;
        const auto& r = std::get<CartesianMeasurement>(detection.measurement).covariance;
        if (r.empty()) continue;
        const Eigen::MatrixXd covariance = Eigen::Map<const Eigen::MatrixXd>(r.data(), d, d);
        EXPECT_TRUE(covariance.isApprox(covariance.transpose(), 0));
        EXPECT_EQ(covariance.llt().info(), Eigen::Success);
      }
    }
  }
}

TEST(RandomScene, TheSameSeedGivesTheSameScene) {
  std::mt19937_64 one(11), other(11);
  const Variety variety = random_variety(one);
  random_variety(other);
  EXPECT_EQ(random_scene(one, variety).frames, random_scene(other, variety).frames);
}

}  // namespace
}  // namespace anchord::enumeration
