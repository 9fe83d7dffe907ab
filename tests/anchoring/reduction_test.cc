#include "anchoring/reduction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "anchoring/world.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

constexpr int kNone = Hypothesis::kNoLeaf;
constexpr double kRounding = 1e-12;

Leaf at(double x, double existence = 1) {
  Leaf leaf;
  leaf.existence = existence;
  leaf.classes = {1};
  Kinematic density;
  density.position.x() = x;
  density.pp.diagonal().setConstant(0.01);
  leaf.models.push_back({1, density});
  return leaf;
}

struct Case {
  double weight;
  std::vector<int> leaf;
};

Cluster cluster_of(const std::vector<std::vector<Leaf>>& anchors, const std::vector<Case>& cases) {
  Cluster cluster;
  for (const auto& leaves : anchors) {
    AnchorTree& tree = cluster.anchors.emplace_back();
    tree.anchor =
        std::make_shared<const Anchor>(Anchor{cluster.anchors.size(), "", "", std::nullopt});
    for (const Leaf& leaf : leaves) tree.leaves.push_back(std::make_shared<const Leaf>(leaf));
  }
  for (const Case& c : cases) {
    Hypothesis h{std::log(c.weight), {}};
    h.leaf.assign(c.leaf.begin(), c.leaf.end());
    cluster.hypotheses.push_back(std::move(h));
  }
  normalise(cluster.hypotheses);
  return cluster;
}

/// Of one anchor over all hypotheses: P(it exists), and then the mean and variance of x.
struct Marginal {
  double p = 0, mean = 0, variance = 0;
};

Marginal marginal_of(const Cluster& cluster, std::size_t anchor) {
  Marginal out;
  double square = 0;
  for (const Hypothesis& h : cluster.hypotheses) {
    if (h.leaf[anchor] == kNone) continue;
    const Leaf& leaf = *cluster.anchors[anchor].leaves[h.leaf[anchor]];
    const auto& density = std::get<Kinematic>(leaf.models[0].density);
    const double w = std::exp(h.log_weight) * leaf.existence, x = density.position.x();
    out.p += w;
    out.mean += w * x;
    square += w * (x * x + density.pp(0, 0));
  }
  out.mean /= out.p;
  out.variance = square / out.p - out.mean * out.mean;
  return out;
}

class Reduction : public ::testing::Test {
 protected:
  const std::shared_ptr<const Background> background_ = World(small_world()).background();
};

TEST_F(Reduction, LeavesWhatHasRoomAsItIs) {
  Cluster cluster = cluster_of({{at(0), at(0.001)}}, {{0.6, {0}}, {0.4, {1}}});
  merge_nearest(cluster, 2, *background_);
  EXPECT_EQ(cluster.hypotheses.size(), 2u);
  merge_nearest(cluster, 0, *background_);
  EXPECT_EQ(cluster.hypotheses.size(), 2u) << "no bound";
}

TEST_F(Reduction, LikeHypothesesBecomeOneBeforeRareOnesGo) {
  // The exchange of the two objects is rare, but it is nothing like the others.
  Cluster cluster = cluster_of({{at(0), at(0.02), at(5)}, {at(5), at(0)}},
                               {{0.6, {0, 0}}, {0.35, {1, 0}}, {0.05, {2, 1}}});
  merge_nearest(cluster, 2, *background_);
  ASSERT_EQ(cluster.hypotheses.size(), 2u);
  EXPECT_NEAR(std::exp(cluster.hypotheses[0].log_weight), 0.95, kRounding);
  EXPECT_NEAR(std::exp(cluster.hypotheses[1].log_weight), 0.05, kRounding);
  EXPECT_EQ(cluster.hypotheses[1].leaf[0], 2);
  EXPECT_EQ(cluster.hypotheses[1].leaf[1], 1);
}

TEST_F(Reduction, AlikeIsMeantOfAllAnchorsAtOnce) {
  // Each anchor alone is in two places of the same kind; only together they differ.
  Cluster cluster = cluster_of({{at(0), at(1)}, {at(0), at(1), at(1.01)}},
                               {{0.4, {0, 1}}, {0.35, {1, 0}}, {0.25, {0, 2}}});
  merge_nearest(cluster, 2, *background_);
  ASSERT_EQ(cluster.hypotheses.size(), 2u);
  EXPECT_NEAR(std::exp(cluster.hypotheses[0].log_weight), 0.65, kRounding);
  EXPECT_NEAR(std::exp(cluster.hypotheses[1].log_weight), 0.35, kRounding);
}

TEST_F(Reduction, WhatIsFarFromAllOthersIsNotForcedIntoThem) {
  Cluster cluster = cluster_of({{at(0), at(5), at(10)}}, {{0.5, {0}}, {0.3, {1}}, {0.2, {2}}});
  merge_nearest(cluster, 1, *background_);
  EXPECT_EQ(cluster.hypotheses.size(), 3u);
}

TEST_F(Reduction, WhereTheMapBeginsDoesNotMatter) {
  for (const double origin : {0.0, 1e3}) {
    const auto wide = [&](double x, double variance) {
      Leaf leaf = at(origin + x);
      std::get<Kinematic>(leaf.models[0].density).pp.diagonal().setConstant(variance);
      return leaf;
    };
    // Nearly the same density, and twice one that only a scale of their own would make the same.
    Cluster cluster = cluster_of({{wide(1, 0.01), wide(1, 0.011), wide(3, 0.09)}},
                                 {{0.5, {0}}, {0.3, {1}}, {0.2, {2}}});
    merge_nearest(cluster, 1, *background_);
    ASSERT_EQ(cluster.hypotheses.size(), 2u) << origin;
    EXPECT_NEAR(std::exp(cluster.hypotheses[0].log_weight), 0.8, kRounding);
  }
}

TEST_F(Reduction, WhatIsAbsentDoesNotBringFarVersionsTogether) {
  // Both are hardly there, so that either alone is close to nothing.
  Leaf other = at(0, 0.01);
  other.models.push_back({0, Kinematic{}});  // of another kind: cannot be mixed at all
  Cluster cluster = cluster_of({{at(0)}, {at(0, 0.01), at(50, 0.01), other}},
                               {{0.4, {0, kNone}}, {0.3, {0, 0}}, {0.2, {0, 1}}, {0.1, {0, 2}}});
  merge_nearest(cluster, 1, *background_);
  EXPECT_EQ(cluster.hypotheses.size(), 3u);
}

TEST_F(Reduction, WhatWasShownStaysShown) {
  Cluster cluster = cluster_of({{at(0), at(0.02), at(0.04)}}, {{0.5, {0}}, {0.3, {1}}, {0.2, {2}}});
  cluster.anchors[0].shown = 2;
  merge_nearest(cluster, 1, *background_);
  ASSERT_EQ(cluster.hypotheses.size(), 1u);
  EXPECT_EQ(cluster.anchors[0].shown, cluster.hypotheses[0].leaf[0]);
}

TEST_F(Reduction, WhatIsSaidOfEachAnchorAloneStaysAsItIs) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 100; ++trial) {
    // The third is hardly there, and in some hypotheses not at all.
    std::vector<std::vector<Leaf>> anchors(3);
    for (int a = 0; a < 3; ++a)
      for (int l = 0; l < 6; ++l)
        anchors[a].push_back(
            at(0.15 * uniform(random), (a < 2 ? 0.98 : 0) + 0.02 * uniform(random)));
    std::vector<Case> cases;
    for (int h = 0; h < 30; ++h) {
      Case& c = cases.emplace_back(Case{uniform(random), {}});
      for (int a = 0; a < 3; ++a)
        c.leaf.push_back(static_cast<int>((a < 2 ? 6 : 7) * uniform(random)) - (a < 2 ? 0 : 1));
    }
    Cluster cluster = cluster_of(anchors, cases);
    const Cluster before = cluster;
    merge_nearest(cluster, 5, *background_);
    EXPECT_LT(cluster.hypotheses.size(), before.hypotheses.size());
    for (std::size_t a = 0; a < 3; ++a) {
      const Marginal was = marginal_of(before, a), is = marginal_of(cluster, a);
      EXPECT_NEAR(is.p, was.p, kRounding);
      EXPECT_NEAR(is.mean, was.mean, kRounding);
      EXPECT_NEAR(is.variance, was.variance, kRounding);
    }
  }
}

TEST_F(Reduction, ForgetsWhatHardlyExistsInAllWorldsTogetherOnceItIsNotSeenAnyMore) {
  const World world(small_world(R"({"hypotheses": {"min_probability": 1e-4}})"));
  const Background& background = *world.background();
  Leaf seen = at(2, 0.5);
  seen.recent.push_back(7 << 16);
  const Cluster before = cluster_of({{at(0)}, {at(1, 0.5)}, {seen}, {at(3, 0.5)}},
                                    {{1 - 1e-3 - 1e-4, {0, kNone, kNone, kNone}},
                                     {1e-3, {0, kNone, kNone, 0}},
                                     {1e-4, {0, 0, 0, kNone}}});
  Cluster cluster = before;
  forget_improbable(cluster, background);
  EXPECT_NEAR(marginal_of(cluster, 0).p, 1, kRounding);
  EXPECT_EQ(cluster.hypotheses[2].leaf[1], kNone) << "5e-5, and not seen of late";
  EXPECT_NEAR(marginal_of(cluster, 2).p, 5e-5, kRounding) << "it may grow";
  EXPECT_NEAR(marginal_of(cluster, 3).p, 5e-4, kRounding);
  // What once had a name may come back.
  Cluster named = before;
  named.anchors[1].anchor = std::make_shared<const Anchor>(Anchor{1, "cup-1", "", std::nullopt});
  forget_improbable(named, background);
  EXPECT_NEAR(marginal_of(named, 1).p, 5e-5, kRounding);
  // Where nothing tells two hypotheses apart any more, they are one.
  Cluster alone = cluster_of({{at(0)}, {at(1, 0.5)}}, {{0.9999, {0, kNone}}, {1e-4, {0, 0}}});
  forget_improbable(alone, background);
  ASSERT_EQ(alone.hypotheses.size(), 1u);
  EXPECT_NEAR(alone.hypotheses[0].log_weight, 0, kRounding);
}

TEST(Limits, WhatIsForgottenFollowsWhatMayExist) {
  const auto forgotten = [](const char* more) { return small_world(more).limits.min_probability; };
  EXPECT_DOUBLE_EQ(forgotten("{}"), 1e-6);
  EXPECT_DOUBLE_EQ(forgotten(R"({"hypotheses": {"min_existence": 1e-3}})"), 1e-5);
  EXPECT_EQ(forgotten(R"({"hypotheses": {"min_probability": 0}})"), 0);
}

}  // namespace
}  // namespace anchord
