#include <gtest/gtest.h>

#include <cmath>

#include "tests/anchoring/dice.h"
#include "tools/anchor_tune/labels.h"

namespace anchord::tuning {
namespace {

using enumeration::Dice;

Judged reported(int truth, std::vector<double> m) {
  Judged z;
  z.verdict = Verdict::kRight;
  z.object_class = truth;
  z.placed.has_class = true;
  for (double& p : m) p *= 2;  // a ratio to a uniform prior
  z.placed.class_ratio = std::move(m);
  return z;
}

Judgement judgement_of(std::vector<Judged> detections) {
  Judgement judgement;
  judgement.sensors = {"camera"};
  judgement.frames.emplace_back().detections = std::move(detections);
  return judgement;
}

TEST(Labels, ReportsThatAreTooSureNeedTheMatrix) {
  std::mt19937_64 random(31);
  Dice dice(random);
  std::vector<Judged> detections;
  int wrong = 0;
  for (int i = 0; i < 400; ++i) {
    const int truth = i % 2;
    const bool right = dice.chance(0.8);
    if (truth == 0 && !right) ++wrong;
    const bool first = right == (truth == 0);
    detections.push_back(reported(truth, {first ? 0.999 : 0.001, first ? 0.001 : 0.999}));
  }
  const auto labels = fit_labels(judgement_of(detections), 0, 2);
  ASSERT_TRUE(labels);
  EXPECT_TRUE(labels->confused);
  EXPECT_EQ(labels->pairs, 400);
  EXPECT_EQ(labels->counts[0][1], wrong);
  EXPECT_NEAR(labels->confusion[0][1], (wrong + 0.5) / 201, 1e-12);
  // Right in 8 of 10: the entropy of that is 0.50; a deviation of its mean is 0.03.
  EXPECT_NEAR(labels->confusion_loss, 0.50, 0.1);
}

TEST(Labels, ReportsThatAreAsSureAsTheyShouldBeDoNot) {
  std::mt19937_64 random(37);
  Dice dice(random);
  std::vector<Judged> detections;
  for (int i = 0; i < 400; ++i) {
    const double p = dice.uniform(0, 1);
    detections.push_back(reported(dice.chance(p) ? 0 : 1, {p, 1 - p}));
  }
  const auto labels = fit_labels(judgement_of(detections), 0, 2);
  ASSERT_TRUE(labels);
  EXPECT_FALSE(labels->confused);
  EXPECT_LT(labels->loss, labels->confusion_loss);
}

TEST(Labels, NothingIsToldWithoutReports) {
  EXPECT_FALSE(fit_labels(judgement_of({}), 0, 2));
  EXPECT_FALSE(fit_labels(judgement_of({reported(0, {0.5, 0.5})}), 0, 1));
  EXPECT_FALSE(fit_labels(judgement_of({reported(0, {0.5, 0.5})}), 1, 2));
}

}  // namespace
}  // namespace anchord::tuning
