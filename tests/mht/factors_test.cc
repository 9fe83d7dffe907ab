#include "mht/factors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace anchord {
namespace {

/// Nothing may be off but rounding.
constexpr Cut kExact{0, 1e-12, 0};

Hypothesis weighing(double p, std::initializer_list<int> leaves) {
  return {std::log(p), {leaves.begin(), leaves.end()}};
}

TEST(Factors, AChangeToTheFirstLeafOfTheFirstAnchorIsAChange) {
  // A detection is the first anchor's, the second's, or starts the third: none is independent.
  const HypothesisSet set{weighing(0.4, {1, 0, Hypothesis::kNoLeaf}), weighing(0.35, {0, 0, 0}),
                          weighing(0.25, {0, 1, Hypothesis::kNoLeaf})};
  const auto factors = factorise(set, kExact);
  ASSERT_EQ(factors.size(), 1u);
  EXPECT_EQ(factors[0].hypotheses.size(), 3u);
}

TEST(Factors, IndependentAnchorsComeApart) {
  HypothesisSet set;
  for (const auto& [p, a] : {std::pair{0.7, 1}, {0.3, 0}})
    for (const auto& [q, b] : {std::pair{0.6, 0}, {0.4, 1}}) set.push_back(weighing(p * q, {a, b}));
  normalise(set);
  const auto factors = factorise(set, kExact);
  ASSERT_EQ(factors.size(), 2u);
  EXPECT_EQ(factors[0].hypotheses[0].leaf[0], 1);
  EXPECT_NEAR(std::exp(factors[0].hypotheses[0].log_weight), 0.7, 1e-12);
  EXPECT_EQ(factors[1].hypotheses[0].leaf[0], 0);
  EXPECT_NEAR(std::exp(factors[1].hypotheses[0].log_weight), 0.6, 1e-12);
}

}  // namespace
}  // namespace anchord
