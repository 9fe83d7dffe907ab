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
    const auto fit = fit_detectability(simulated(0.9, 0.3, 1.5, 30, dice), 1, false);
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
    const auto fit = fit_detectability(simulated(0.8, 0, 0, 10, dice), 1, false);
    EXPECT_FALSE(fit.hidden) << "the criterion is wrong in one of some thousand";
    // A normal deviation is 0.4 / sqrt(1000); four of them.
    EXPECT_NEAR(fit.detection_probability[0].value, 0.8, 0.05);
  }
}

/// Looks from distances that change from one object to the next, and a little from look to look.
Glances seen_from_afar(double near, double per_m, double hide, double show, Dice& dice) {
  Glances glances = simulated(1, hide, show, 40, dice);
  for (auto& looks : glances) {
    const double away = dice.uniform(0, 50);
    for (Glance& look : looks) {
      look.range = away + dice.uniform(0, 5);
      const double odds = near / (1 - near) * std::exp(per_m * look.range);
      look.found = look.found && dice.chance(odds / (1 + odds));
    }
  }
  return glances;
}

TEST(Chain, FindsHowDetectionFallsWithTheDistance) {
  std::mt19937_64 random(17);
  Dice dice(random);
  constexpr double kNear = 0.97, kPerM = -0.08;
  int inside = 0, alone = 0;
  for (int scene = 0; scene < 20; ++scene) {
    const auto fit = fit_detectability(seen_from_afar(kNear, kPerM, 0.3, 1.5, dice), 1, true);
    ASSERT_TRUE(fit.hidden && fit.per_m);
    EXPECT_GT(fit.range_gain, 10);
    const Estimate& p = fit.detection_probability[0];
    inside += p.low < kNear && kNear < p.high;
    inside += fit.per_m->low < kPerM && kPerM < fit.per_m->high;
    inside += fit.hide.low < 0.3 && 0.3 < fit.hide.high;
    inside += fit.show.low < 1.5 && 1.5 < fit.show.high;
    const auto one_number =
        fit_detectability(seen_from_afar(kNear, kPerM, 0.3, 1.5, dice), 1, false);
    EXPECT_TRUE(one_number.range_pays && !one_number.per_m);
    const auto always = fit_detectability(seen_from_afar(kNear, kPerM, 0, 0, dice), 1, true);
    ASSERT_TRUE(always.per_m);
    EXPECT_FALSE(always.hidden) << "the criterion is wrong in one of some thousand";
    alone +=
        always.detection_probability[0].low < kNear && kNear < always.detection_probability[0].high;
    alone += always.per_m->low < kPerM && kPerM < always.per_m->high;
  }
  // 76 of 80 and 38 of 40 are expected; fewer than 69 and 33 in one run of some hundred.
  EXPECT_GE(inside, 69);
  EXPECT_GE(alone, 33);
}

TEST(Chain, DetectionThatDoesNotFallIsOneNumber) {
  std::mt19937_64 random(19);
  Dice dice(random);
  int ranged = 0;
  for (int scene = 0; scene < 20; ++scene)
    ranged += fit_detectability(seen_from_afar(0.8, 0, 0.3, 1.5, dice), 1, true).per_m.has_value();
  // Of 4000 looks the criterion asks for 4.1 in log-likelihood: chance is that good once in 250.
  EXPECT_LE(ranged, 1);
}

TEST(Chain, ASensorWithoutLooksIsUnknown) {
  const auto fit = fit_detectability({{{0, 0, true}, {0.1, 0, true}}}, 2, false);
  EXPECT_EQ(fit.detection_probability[0].value, 1);
  EXPECT_EQ(fit.detection_probability[1].low, 0);
  EXPECT_EQ(fit.detection_probability[1].high, 1);
}

}  // namespace
}  // namespace anchord::tuning
