#include "anchoring/seen_share.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/anchoring/dice.h"

namespace anchord {
namespace {

constexpr std::uint32_t kLeft = 1, kRight = 2;  ///< two cameras

SeenPart seen(double v, std::uint32_t viewer = kLeft, double variance = 1) {
  return {v, viewer, variance};
}

TEST(SeenShare, BeforeAnyLookItIsWhatIsInView) {
  const SeenShare share;
  for (const double v : {0.0, 0.3, 1.0}) EXPECT_EQ(share.share(seen(v)), v);
}

TEST(SeenShare, WhatIsMissedAgainAndAgainByAStillViewIsOutOfIt) {
  SeenShare share;
  double stays = 1;  // the odds of existing, of what they were
  for (int i = 0; i < 100; ++i) {
    const double s = share.share(seen(0.025));
    EXPECT_NEAR(s, 0.025 * std::pow(0.1, i) / (0.975 + 0.025 * std::pow(0.1, i)), 1e-12);
    share.miss(seen(0.025), 0.9 * s);
    stays *= 1 - 0.9 * s;
  }
  EXPECT_NEAR(stays, 0.975, 1e-9);
}

TEST(SeenShare, WhatWasFoundIsInView) {
  SeenShare share;
  share.miss(seen(0.5), 0.45);
  share.find(seen(0.4));
  EXPECT_EQ(share.share(seen(0.4)), 1);
  EXPECT_EQ(share.share(seen(0.7)), 1);
  EXPECT_DOUBLE_EQ(share.share(seen(0.1)), 0.25) << "of a view that moves on";
  share.miss(seen(0.4), 0.9);
  EXPECT_NEAR(share.share(seen(0.4)), 1, 1e-15) << "it is gone, or overlooked";
  share.find(seen(1e-6));
  EXPECT_EQ(share.share(seen(0.4)), 0.4) << "the view is not what it is said to be";
}

TEST(SeenShare, AnotherCamerasLooksDoNotCount) {
  SeenShare share;
  share.find(seen(0.5, kLeft));
  EXPECT_EQ(share.share(seen(0.5, kRight)), 0.5);
  share.miss(seen(0.5, kRight), 0.45);
  EXPECT_EQ(share.share(seen(0.5, kLeft)), 0.5);
  EXPECT_LT(share.share(seen(0.5, kRight)), 0.1);
}

TEST(SeenShare, LooksFadeAsTheDensitySpreads) {
  SeenShare share;
  share.find(seen(0.5));
  EXPECT_DOUBLE_EQ(share.share(seen(0.5, kLeft, 4)), 0.75);
  share.miss(seen(0.5, kLeft, 4), 0.75 * 0.9);
  EXPECT_NEAR(share.share(seen(0.5, kLeft, 4)), 0.075 / 0.325, 1e-12);
  EXPECT_NEAR(share.share(seen(0.5, kLeft, 1e12)), 0.5, 1e-5);
}

/// The object's place, in quantiles of its density from what is seen first on; views of a growing
/// and shrinking part of it.
TEST(SeenShare, IsExactForViewsThatHoldEachOther) {
  std::mt19937_64 random(5);
  enumeration::Dice dice(random);
  constexpr int kCells = 1000;
  for (int n = 0; n < 200; ++n) {
    SeenShare share;
    std::vector<double> truth(kCells, 1.0 / kCells);
    // As many masses as are remembered.
    std::vector<int> masses;
    for (std::size_t i = 0; i < SeenShare::kMost; ++i)
      masses.push_back(dice.integer(1, kCells - 1));
    for (int look = 0; look < 20; ++look) {
      const int cells = masses[dice.integer(0, static_cast<int>(masses.size()) - 1)];
      const double v = static_cast<double>(cells) / kCells, p = dice.uniform(0.1, 0.9);
      double in_view = 0;
      for (int i = 0; i < cells; ++i) in_view += truth[i];
      ASSERT_NEAR(share.share(seen(v)), in_view, 1e-9);
      const bool found = look == 0 && dice.chance(0.5);  // its place is known anew then
      if (found)
        share.find(seen(v));
      else
        share.miss(seen(v), p * in_view);
      double sum = 0;
      for (int i = 0; i < kCells; ++i)
        sum += truth[i] *= found ? (i < cells ? 1 : 0) : (i < cells ? 1 - p : 1);
      for (double& t : truth) t /= sum;
    }
  }
}

/// A view that trembles: each look at another mass.
TEST(SeenShare, ATremblingViewLosesLittle) {
  std::mt19937_64 random(6);
  enumeration::Dice dice(random);
  SeenShare share;
  double stays = 1, widest = 0;
  for (int i = 0; i < 1000; ++i) {
    const double v = dice.uniform(0.2, 0.3), lost = 0.9 * share.share(seen(v));
    widest = std::max(widest, v);
    share.miss(seen(v), lost);
    stays *= 1 - lost;
  }
  EXPECT_NEAR(stays, 1 - widest, 0.01);
}

TEST(SeenShare, OfAMixtureItIsTheMixtures) {
  std::mt19937_64 random(7);
  enumeration::Dice dice(random);
  for (int n = 0; n < 200; ++n) {
    SeenShare a, b;
    for (SeenShare* share : {&a, &b})
      for (int i = dice.integer(0, 2); i > 0; --i) {
        const double v = dice.uniform(0.01, 0.99);
        if (dice.chance(0.3))
          share->find(seen(v));
        else
          share->miss(seen(v), dice.uniform(0, 0.9) * share->share(seen(v)));
      }
    const double wa = dice.uniform(0.1, 1), wb = dice.uniform(0.1, 1);
    const SeenShare both = SeenShare::merge(wa, a, wb, b);
    for (double v = 0.05; v < 1; v += 0.1) {
      const double mixed = (wa * a.share(seen(v)) + wb * b.share(seen(v))) / (wa + wb);
      EXPECT_NEAR(both.share(seen(v)), mixed, 1e-12);
      EXPECT_LE(std::abs(a.share(seen(v)) - b.share(seen(v))), SeenShare::difference(a, b) + 1e-12);
    }
  }
}

}  // namespace
}  // namespace anchord
