#include "tools/anchor_tune/estimate.h"

#include <gtest/gtest.h>

namespace anchord::tuning {
namespace {

// Expected values are those of published tables, given to as many digits as compared here.

TEST(Estimate, PoissonRatesHaveGarwoodsInterval) {
  const Estimate none = poisson_rate(0, 1);
  EXPECT_EQ(none.low, 0);
  EXPECT_NEAR(none.high, 3.689, 5e-4);
  const Estimate ten = poisson_rate(10, 2);
  EXPECT_EQ(ten.value, 5);
  EXPECT_NEAR(ten.low, 4.795 / 2, 5e-4);
  EXPECT_NEAR(ten.high, 18.390 / 2, 5e-4);
}

TEST(Estimate, SharesHaveClopperAndPearsonsInterval) {
  const Estimate none = binomial_share(0, 10);
  EXPECT_EQ(none.low, 0);
  EXPECT_NEAR(none.high, 0.3085, 5e-5);
  const Estimate most = binomial_share(8, 10);
  EXPECT_NEAR(most.low, 0.4439, 5e-5);
  EXPECT_NEAR(most.high, 0.9748, 5e-5);
  EXPECT_EQ(binomial_share(10, 10).high, 1);
}

TEST(Estimate, VariancesHaveTheChiSquaredInterval) {
  // 10 degrees of freedom: quantiles 3.247 and 20.483.
  const Estimate scale = variance_scale(10, 10);
  EXPECT_EQ(scale.value, 1);
  EXPECT_NEAR(scale.low, 10 / 20.483, 5e-5);
  EXPECT_NEAR(scale.high, 10 / 3.247, 5e-4);
}

TEST(Estimate, ReadsAsText) {
  EXPECT_EQ((Estimate{0.5, 0.25, 0.75}).text(), "0.5 (95 %: 0.25 to 0.75)");
}

}  // namespace
}  // namespace anchord::tuning
