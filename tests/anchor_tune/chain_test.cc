#include "tools/anchor_tune/chain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/anchoring/dice.h"

namespace anchord::tuning {
namespace {

using enumeration::Dice;

/// P(found and missed), summed over every sequence of states.
double by_enumeration(const std::vector<Glance>& looks, const std::vector<double>& p, double hide,
                      double show) {
  double sum = 0;
  const double hidden = hide / (hide + show);
  for (unsigned states = 0; states < 1u << looks.size(); ++states) {
    double weight = 1;
    for (std::size_t i = 0; i < looks.size(); ++i) {
      const bool here = states >> i & 1, before = i > 0 && (states >> (i - 1) & 1);
      // A two-state chain forgets where it was as exp(-(hide + show) dt).
      const double forgotten = i > 0 ? -std::expm1(-(hide + show) * looks[i].seconds) : 1;
      const double to_hidden = hidden * forgotten + (i > 0 && before ? 1 - forgotten : 0);
      weight *= here ? to_hidden : 1 - to_hidden;
      const double found = here ? 0 : p[looks[i].sensor];
      weight *= looks[i].found ? found : 1 - found;
    }
    sum += weight;
  }
  return sum;
}

TEST(Chain, ForwardRecursionEqualsTheSumOverStates) {
  std::mt19937_64 random(7);
  Dice dice(random);
  for (int scene = 0; scene < 50; ++scene) {
    const std::vector<double> p{dice.uniform(0.1, 0.9), dice.uniform(0.1, 0.9)};
    const double hide = dice.scale(0.1, 5), show = dice.scale(0.1, 5);
    std::vector<Glance> looks;
    for (int i = 0; i < 8; ++i)
      looks.push_back({i > 0 ? dice.uniform(0, 2) : 0, dice.integer(0, 1), dice.chance(0.5)});
    // Sums of 256 products: rounding only.
    EXPECT_NEAR(log_likelihood({looks}, p, hide, show),
                std::log(by_enumeration(looks, p, hide, show)), 1e-11);
  }
}

Glances simulated(double p, double hide, double show, int objects, Dice& dice) {
  Glances glances;
  for (int object = 0; object < objects; ++object) {
    auto& looks = glances.emplace_back();
    bool hidden = hide > 0 && dice.chance(hide / (hide + show));
    for (int i = 0; i < 100; ++i) {
      const double dt = i > 0 ? dice.uniform(0.05, 0.15) : 0;
      const double changes = hide > 0 ? -std::expm1(-(hide + show) * dt) / (hide + show) : 0;
      if (dice.chance((hidden ? show : hide) * changes)) hidden = !hidden;
      looks.push_back({dt, 0, !hidden && dice.chance(p)});
    }
  }
  return glances;
}

TEST(Chain, FindsARateOfHidingWhereThereIsOne) {
  std::mt19937_64 random(11);
  Dice dice(random);
  int inside = 0;
  for (int scene = 0; scene < 20; ++scene) {
    const auto fit = fit_detectability(simulated(0.9, 0.3, 1.5, 30, dice), 1);
    ASSERT_TRUE(fit.hidden);
    const Estimate& p = fit.detection_probability[0];
    inside += p.low < 0.9 && 0.9 < p.high;
    inside += fit.hide.low < 0.3 && 0.3 < fit.hide.high;
    inside += fit.show.low < 1.5 && 1.5 < fit.show.high;
  }
  // 57 of 60 are expected; fewer than 51 in one run of a thousand.
  EXPECT_GE(inside, 51);
}

TEST(Chain, MissesThatDoNotComeTogetherNeedNone) {
  std::mt19937_64 random(13);
  Dice dice(random);
  for (int scene = 0; scene < 20; ++scene) {
    const auto fit = fit_detectability(simulated(0.8, 0, 0, 10, dice), 1);
    EXPECT_FALSE(fit.hidden) << "the criterion is wrong in one of some thousand";
    // A normal deviation is 0.4 / sqrt(1000); four of them.
    EXPECT_NEAR(fit.detection_probability[0].value, 0.8, 0.05);
  }
}

TEST(Chain, ASensorWithoutLooksIsUnknown) {
  const auto fit = fit_detectability({{{0, 0, true}, {0.1, 0, true}}}, 2);
  EXPECT_EQ(fit.detection_probability[0].value, 1);
  EXPECT_EQ(fit.detection_probability[1].low, 0);
  EXPECT_EQ(fit.detection_probability[1].high, 1);
}

}  // namespace
}  // namespace anchord::tuning
