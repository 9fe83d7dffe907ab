#include "maintenance/subject.h"

#include <gtest/gtest.h>

#include <cmath>

#include "knowledge/configuration.h"
#include "maintenance/entropy.h"
#include "maintenance/gain.h"
#include "maintenance/roi.h"
#include "tests/maintenance/small_home.h"

namespace anchord {
namespace {

/// Cups and mugs, which a camera confuses in one case of five, and their colour.
constexpr const char* kTwoClasses = R"({
  "world": {"dimensions": 2, "bounds": {"min": [0, 0], "max": [10, 10]}},
  "attributes": {"class": {"kind": "categorical", "symbols": ["cup", "mug"]},
                 "color": {"kind": "categorical", "symbols": ["red", "blue"]},
                 "size": {"kind": "scalar"}},
  "classes": {"default": {"models": [{"kind": "constant_position", "position_psd": 0.01},
                                     {"kind": "somewhere", "rate": 0.01}]}},
  "sensors": {"eye": {"view": {"type": "sector", "range": [0, 3], "bearing": [-1, 1]},
                      "noise": [0.01, 0, 0, 0.01],
                      "detection_probability": {"cup": 0.9, "mug": 0.6},
                      "confusion": {"class": {"cup": {"cup": 0.8}, "mug": {"mug": 0.8}}},
                      "verification": {}}}})";

TEST(Subject, PredictsWhatTheBeliefPredicts) {
  World world =
      with_a_cup_that_gets_lost(R"({"kind": "constant_velocity", "acceleration_psd": 0.01})");
  ASSERT_TRUE(world.apply(cups_at({{5.1, 5}}, kStart + 1'000'000)).ok());
  const Site site(world.background()->knowledge);
  const std::vector<Subject> now{subject_of(only_object(world, 1), *world.background())};
  const std::vector<Subject> later{subject_of(only_object(world, 21), *world.background())};
  const double by_forecast = Forecast(now, site).entropies(0, 20).without;
  const double by_belief = Forecast(later, site).entropies(0, 0).without;
  // Mass that enters `somewhere` after the reading counts as a component of its own: that adds the
  // entropy of which of the two it is, at most ln 2 of the 0.19 that is there by then.
  EXPECT_NEAR(by_forecast, by_belief, 0.19 * std::log(2.0));
  EXPECT_GE(by_forecast, by_belief - 1e-6);
}

TEST(Subject, IsAsUncertainAsItsObject) {
  World world = with_a_cup_that_gets_lost(R"({"kind": "constant_position", "position_psd": 0.01})");
  const Site site(world.background()->knowledge);
  for (const double seconds : {0.0, 1.0, 20.0, 100.0}) {
    const ObjectBelief object = only_object(world, seconds);
    const std::vector<Subject> subjects{subject_of(object, *world.background())};
    double sum = 0, area = 0;
    for (const auto& track : subjects[0].tracks) sum += track.weight;
    for (const auto& tile : subjects[0].tiles) sum += tile.weight, area += tile.volume;
    EXPECT_NEAR(sum, 1, 1e-12);
    if (seconds > 2) {
      EXPECT_NEAR(area, 100, 1e-9);
    }
    const double own = entropy(object, *world.background());
    const double bound = Forecast(subjects, site).entropies(0, 0).without;
    if (seconds < 50) {
      EXPECT_NEAR(bound, own, 1e-6) << seconds;
    } else {
      // The Gaussian of equal moments has less: the forecast does without it.
      EXPECT_GE(bound, own);
      EXPECT_LE(bound, own + 0.1);
    }
  }
}

TEST(Subject, VersionsThatAreAlikeBecomeOneTrack) {
  World world(room());
  // Two cups close together, reported twice: which report is whose is open.
  ASSERT_TRUE(world.apply(cups_at({{5, 5}, {5.1, 5}}, kStart)).ok());
  ASSERT_TRUE(world.apply(cups_at({{5.04, 5}, {5.06, 5}}, kStart + 1'000'000)).ok());
  const auto objects = read_objects(*world.belief(), kStart + 1'000'000, 0.5, *world.background());
  ASSERT_EQ(objects.size(), 2u);
  for (const ObjectBelief& object : objects) {
    ASSERT_GT(object.versions.size(), 1u);
    const Subject subject = subject_of(object, *world.background());
    ASSERT_EQ(subject.tracks.size(), 1u);
    const Gaussian moments = object.moments(*world.background());
    EXPECT_NEAR((subject.tracks[0].state.position - moments.mean).norm(), 0, 1e-6);
    EXPECT_NEAR((subject.tracks[0].state.pp - moments.covariance).norm(), 0, 1e-6);
  }
}

TEST(Subject, KnowsHowOftenASensorSeesItAndWhatThatTellsOfItsClass) {
  World world(parse_configuration(kTwoClasses).knowledge());
  Frame frame = cups_at({{5, 5}}, kStart);
  frame.detections[0].attributes = {{"color", SymbolReport{{{"red", 0.9}, {"blue", 0.1}}}},
                                    {"size", ScalarReport{0.1, 0.0004}}};
  ASSERT_TRUE(world.apply(frame).ok());
  const ObjectBelief object = only_object(world, 0);
  const std::vector<double> b = object.classes(*world.background());
  const Subject subject = subject_of(object, *world.background());
  ASSERT_EQ(subject.detection_probability.size(), 1u);
  EXPECT_NEAR(subject.detection_probability[0].near, 0.9 * b[0] + 0.6 * b[1], 1e-12);
  // The symmetric channel: H_b(reported) - H_b(0.2).
  const double reported = 0.8 * b[0] + 0.2 * b[1];
  EXPECT_NEAR(subject.class_gain[0], binary_entropy(reported) - binary_entropy(0.2), 1e-12);
  EXPECT_NEAR(subject.class_entropy, binary_entropy(b[0]), 1e-12);
  EXPECT_NEAR(subject.attribute_entropy,
              binary_entropy(0.1) + 0.5 * std::log(2 * M_PI * std::exp(1.0) * 0.0004), 1e-12);

  const auto looks = appearance_of(object, *world.background());
  ASSERT_EQ(looks.size(), 2u);
  EXPECT_EQ(looks[0].name, "color");
  EXPECT_NEAR(std::get<SymbolReport>(looks[0].value).probabilities[0].second, 0.9, 1e-12);
  EXPECT_EQ(std::get<ScalarReport>(looks[1].value).mean, 0.1);
}

}  // namespace
}  // namespace anchord
