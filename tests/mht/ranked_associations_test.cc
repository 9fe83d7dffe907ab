#include "mht/ranked_associations.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "brute_force.h"

namespace anchord {
namespace {

/// Gains as they come about: many impossible, some worth more than new or clutter.
AssociationProblem random_problem(std::mt19937_64& random, int max_detections, int max_leaves,
                                  int max_parents) {
  const auto upto = [&](int n) { return static_cast<int>(random() % (n + 1)); };
  const auto real = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  AssociationProblem problem;
  problem.detections = upto(max_detections);
  const int leaves = upto(max_leaves);
  for (int i = 0; i < leaves * problem.detections; ++i)
    problem.gain.push_back(upto(3) == 0 ? kLogZero : real(-8, 12));
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
    std::set<std::pair<int, boost::container::small_vector<int, 8>>> seen;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const auto next = ranked.next();
      ASSERT_TRUE(next.has_value()) << "trial " << trial << ", rank " << i;
      // 1e-9: sums of at most six numbers of size 10, in another order.
      ASSERT_NEAR(next->log_weight, expected[i].log_weight, 1e-9) << "trial " << trial;
      ASSERT_TRUE(seen.insert({next->parent, next->leaf_of}).second) << "given twice";
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
