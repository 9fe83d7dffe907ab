#include <gtest/gtest.h>

#include <cmath>

#include "tests/anchoring/dice.h"
#include "tools/anchor_tune/fleeting.h"
#include "tools/anchor_tune/score_memory.h"

namespace anchord::tuning {
namespace {

using enumeration::Dice;

Fleeting kind(double share, double p, double departure, double hide, double show) {
  Fleeting f;
  f.share.value = share;
  f.detection_probability.value = p;
  f.departure.value = departure;
  f.hidden = hide > 0;
  f.hide.value = hide;
  f.show.value = show;
  return f;
}

constexpr double kStep = 0.1;  // s between looks
constexpr int kVain = 10;      // looks in vain end a chain

/// Looks at one thing of a kind, simulated in steps that are short against its rates.
Looks looks_at(const Fleeting& f, Dice& dice) {
  Looks out;
  bool there = true, hidden = false;
  const double both = f.hide.value + f.show.value;
  const double changes = both > 0 ? -std::expm1(-both * kStep) / both : 0;
  for (int vain = 0; vain < kVain;) {
    there = there && !dice.chance(-std::expm1(-f.departure.value * kStep));
    if (dice.chance((hidden ? f.show.value : f.hide.value) * changes)) hidden = !hidden;
    const bool found = there && !hidden && dice.chance(f.detection_probability.value);
    out.push_back({kStep, 0, found});
    vain = found ? 0 : vain + 1;
  }
  return out;
}

/// Of a thousand chains so many of each kind, the others clutter.
std::vector<Looks> chains_of(const std::vector<Fleeting>& kinds, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Dice dice(random);
  std::vector<Looks> chains;
  for (int i = 0; i < 1000; ++i) {
    double draw = dice.uniform(0, 1);
    std::size_t k = 0;
    while (k < kinds.size() && draw >= kinds[k].share.value) draw -= kinds[k++].share.value;
    chains.push_back(k < kinds.size() ? looks_at(kinds[k], dice)
                                      : Looks(kVain, Glance{kStep, 0, false}));
  }
  return chains;
}

/// Whether the intervals hold what is true of a kind.
std::vector<bool> holds(const Fleeting& found, const Fleeting& truth) {
  const auto in = [](const Estimate& e, const Estimate& t) {
    return e.low <= t.value && t.value <= e.high;
  };
  std::vector<bool> out{in(found.share, truth.share),
                        in(found.detection_probability, truth.detection_probability),
                        in(found.departure, truth.departure)};
  if (truth.hidden) out.insert(out.end(), {in(found.hide, truth.hide), in(found.show, truth.show)});
  return out;
}

/// In 20 runs an interval of 95 % fails more than four times in one of four hundred.
constexpr int kRuns = 20, kEnough = 16;

TEST(Fleeting, IntervalsHoldTheTruth) {
  for (const Fleeting& truth : {kind(0.5, 0.8, 0.8, 0, 0), kind(0.6, 0.9, 0.5, 2, 3)}) {
    std::vector<int> hits(5, 0);
    for (int run = 0; run < kRuns; ++run) {
      const auto found = fit_fleeting(chains_of({truth}, 10 + run), 1);
      ASSERT_TRUE(found);
      ASSERT_EQ(found->kinds[0].hidden, truth.hidden);
      const auto good = holds(found->kinds[0], truth);
      for (std::size_t i = 0; i < good.size(); ++i) hits[i] += good[i];
    }
    for (std::size_t i = 0; i < (truth.hidden ? 5u : 3u); ++i) EXPECT_GE(hits[i], kEnough) << i;
  }
}

TEST(Fleeting, TwoKindsAreToldApart) {
  const Fleeting lasting = kind(0.2, 0.9, 0.2, 0, 0), brief = kind(0.5, 0.4, 1.5, 0, 0);
  const auto found = fit_fleeting(chains_of({lasting, brief}, 5), 2);
  ASSERT_TRUE(found);
  // Four deviations or so of some hundred chains.
  EXPECT_NEAR(found->kinds[0].detection_probability.value, 0.9, 0.03);
  EXPECT_NEAR(found->kinds[0].departure.value, 0.2, 0.08);
  EXPECT_NEAR(found->kinds[1].detection_probability.value, 0.4, 0.15);
  const auto shares = found->shares(Looks(60, Glance{kStep, 0, true}));
  EXPECT_GT(shares[0], 0.99) << "six seconds without a miss are the lasting kind's";
}

TEST(Fleeting, NothingThatIsFoundAgainTellsNothing) {
  EXPECT_FALSE(fit_fleeting({Looks(kVain, Glance{kStep, 0, false})}, 1));
  EXPECT_FALSE(fit_fleeting({}, 1));
}

/// Scores of so many things, each with a part that lasts.
std::vector<ScoreSeries> scores(double mean, double share, double seconds, Dice& dice) {
  std::vector<ScoreSeries> out(200);
  for (ScoreSeries& series : out) {
    double lasting = std::sqrt(share) * dice.normal();
    const double kept = std::exp(-kStep / seconds);
    for (int i = 0; i < 30; ++i) {
      series.seconds.push_back(i * kStep);
      series.log_odds.push_back(mean + 2 * (lasting + std::sqrt(1 - share) * dice.normal()));
      lasting = kept * lasting + std::sqrt((1 - kept * kept) * share) * dice.normal();
    }
  }
  return out;
}

/// Their mean and variance are estimated, too, from what is in effect some hundred scores.
TEST(ScoreMemory, IsFound) {
  std::mt19937_64 random(3);
  Dice dice(random);
  const auto found = fit_score_memory(scores(-1, 0.6, 1.5, dice));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->share.value, 0.6, 0.08);
  EXPECT_NEAR(found->seconds.value, 1.5, 0.45);
  EXPECT_EQ(found->scores, 6000);
}

TEST(ScoreMemory, IndependentScoresHaveNone) {
  std::mt19937_64 random(4);
  Dice dice(random);
  EXPECT_FALSE(fit_score_memory(scores(-1, 0, 1, dice)));
  EXPECT_FALSE(fit_score_memory({}));
}

}  // namespace
}  // namespace anchord::tuning
