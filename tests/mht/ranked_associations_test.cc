#include "mht/ranked_associations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "brute_force.h"

namespace anchord {
namespace {

/// Gains as they come about: many impossible, some worth more than new or clutter.
AssociationProblem random_problem(std::mt19937_64& random, int max_detections, int max_leaves,
                                  int max_parents, int density = 3) {
  const auto upto = [&](int n) { return static_cast<int>(random() % (n + 1)); };
  const auto real = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  AssociationProblem problem;
  problem.detections = upto(max_detections);
  const int leaves = upto(max_leaves);
  problem.gains.resize(leaves);
  for (auto& gains : problem.gains)
    for (int z = 0; z < problem.detections; ++z)
      if (upto(density) > 0) gains.push_back({z, real(-8, 12)});
  for (int p = 0; p <= upto(max_parents - 1); ++p) {
    AssociationProblem::Parent parent{real(-6, 0), {}};
    for (int l = 0; l < leaves; ++l)
      if (upto(4) > 0) parent.leaves.push_back(l);
    problem.parents.push_back(parent);
  }
  return problem;
}

TEST(RankedAssociations, GiveEveryAssociationOnceAndBestFirst) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const auto problem = random_problem(random, 4, 5, 3);
    const auto expected = testing::every_association(problem);
    RankedAssociations ranked(problem);
    std::set<std::pair<int, std::vector<int>>> seen;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const auto next = ranked.next();
      ASSERT_TRUE(next.has_value()) << "trial " << trial << ", rank " << i;
      // 1e-9: sums of at most six numbers of size 10, in another order.
      ASSERT_NEAR(next->log_weight, expected[i].log_weight, 1e-9) << "trial " << trial;
      ASSERT_TRUE(seen.insert({next->parent, {next->leaf_of.begin(), next->leaf_of.end()}}).second)
          << "given twice";
    }
    ASSERT_FALSE(ranked.next().has_value()) << "trial " << trial;
  }
}

TEST(RankedAssociations, FirstHundredOfLargerProblemsAreTheBest) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 60; ++trial) {
    const auto problem = random_problem(random, 6, 6, 4);
    const auto expected = testing::every_association(problem);
    RankedAssociations ranked(problem);
    for (std::size_t i = 0; i < std::min<std::size_t>(100, expected.size()); ++i)
      ASSERT_NEAR(ranked.next()->log_weight, expected[i].log_weight, 1e-9) << "trial " << trial;
  }
}

/// What is large is taken apart by what is wanted; ranked as one it is the same.
TEST(RankedAssociations, LargeProblemsAreRankedAsIfNotTakenApart) {
  std::mt19937_64 random(6);
  for (int trial = 0; trial < 40; ++trial) {
    constexpr int kDetections = 20, kLeaves = 22;
    AssociationProblem problem;
    problem.detections = kDetections;
    PairGains gains(kDetections, kLeaves);
    std::vector<std::vector<double>> gain(kDetections, std::vector<double>(kLeaves, kLogZero));
    for (auto& row : gain)
      for (int pair = 0; pair < 2 + trial % 3; ++pair)
        row[random() % kLeaves] = -3 + 10 * static_cast<double>(random() >> 11) * 0x1p-53;
    problem.gains.resize(kLeaves);
    problem.parents.push_back({-1.0, {}});
    for (int z = 0; z < kDetections; ++z) {
      gains.start_row();
      for (int leaf = 0; leaf < kLeaves; ++leaf) {
        if (gain[z][leaf] == kLogZero) continue;
        gains.add(leaf, gain[z][leaf]);
        problem.gains[leaf].push_back({z, gain[z][leaf]});
      }
    }
    for (int leaf = 0; leaf < kLeaves; ++leaf) problem.parents[0].leaves.push_back(leaf);
    RankedAssociations taken_apart(problem);
    RankedAssignments as_one(gains, -kLogZero);
    std::set<std::vector<int>> seen;
    for (std::size_t i = 0; i < 300; ++i) {
      const auto next = taken_apart.next();
      ASSERT_EQ(next.has_value(), as_one.has(i)) << "trial " << trial << ", rank " << i;
      if (!next) break;
      ASSERT_NEAR(next->log_weight, as_one.gain(i) - 1, 1e-9) << trial << ' ' << i;
      ASSERT_TRUE(seen.insert({next->leaf_of.begin(), next->leaf_of.end()}).second)
          << "given twice";
    }
  }
}

TEST(RankedAssociations, BestOfAParentIsTheFirstOfIts) {
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 200; ++trial) {
    const auto problem = random_problem(random, 4, 5, 3);
    const auto expected = testing::every_association(problem);
    RankedAssociations ranked(problem, -1);
    for (int p = 0; p < static_cast<int>(problem.parents.size()); ++p) {
      const auto first = std::find_if(expected.begin(), expected.end(),
                                      [&](const Association& a) { return a.parent == p; });
      const Association best = ranked.best_of(p);
      EXPECT_EQ(best.parent, p);
      EXPECT_NEAR(best.log_weight, first->log_weight, 1e-9) << trial;  // as above
      EXPECT_EQ(best.leaf_of, first->leaf_of) << trial;
    }
  }
}

TEST(RankedAssociations, WithoutDetectionsEachParentComesOnce) {
  AssociationProblem problem;
  problem.parents = {{-2.0, {}}, {-1.0, {}}};
  RankedAssociations ranked(problem);
  EXPECT_EQ(ranked.next()->parent, 1);
  EXPECT_EQ(ranked.next()->parent, 0);
  EXPECT_FALSE(ranked.next().has_value());
}

}  // namespace
}  // namespace anchord
