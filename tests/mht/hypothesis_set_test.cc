#include "mht/hypothesis_set.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mht/factors.h"

namespace anchord {
namespace {

HypothesisSet set_of(std::vector<std::pair<double, std::vector<int>>> entries) {
  HypothesisSet set;
  for (auto& [weight, leaf] : entries)
    set.push_back({std::log(weight), {leaf.begin(), leaf.end()}});
  normalise(set);
  return set;
}

double total(const HypothesisSet& set) {
  double sum = 0;
  for (const auto& h : set) sum += std::exp(h.log_weight);
  return sum;
}

TEST(HypothesisSet, EqualOnesAreMadeOne) {
  auto set = set_of({{0.2, {0, 1}}, {0.5, {1, 0}}, {0.3, {0, 1}}});
  merge_equal(set);
  ASSERT_EQ(set.size(), 2u);
  EXPECT_NEAR(std::exp(set[0].log_weight), 0.5, 1e-15);
  EXPECT_NEAR(total(set), 1, 1e-15);
}

TEST(HypothesisSet, PruningTellsWhatItDropped) {
  auto set = set_of({{0.6, {0}}, {0.3, {1}}, {0.1, {2}}});
  EXPECT_NEAR(prune(set, 2, 0), 0.1, 1e-15);
  EXPECT_EQ(set.size(), 2u);
  EXPECT_NEAR(total(set), 1, 1e-15);
  EXPECT_NEAR(prune(set, 0, 0.9), 1.0 / 3, 1e-15) << "the best one always stays";
  EXPECT_EQ(set.size(), 1u);
}

TEST(HypothesisSet, JoinIsTheProductBestFirst) {
  const auto a = set_of({{0.7, {0}}, {0.2, {1}}, {0.1, {2}}});
  const auto b = set_of({{0.6, {0, 0}}, {0.4, {1, 1}}});
  const auto all = join(a, b, 0, 0);
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[0].leaf, (decltype(Hypothesis::leaf){0, 0, 0}));
  EXPECT_NEAR(std::exp(all[5].log_weight), 0.04, 1e-15);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_LE(all[i].log_weight, all[i - 1].log_weight);
  const auto three = join(a, b, 3, 0);
  ASSERT_EQ(three.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(three[i].leaf, all[i].leaf);
}

std::vector<std::vector<int>> groups(const PoolVector<Factor>& factors) {
  std::vector<std::vector<int>> out;
  for (const auto& factor : factors) out.emplace_back(factor.anchors.begin(), factor.anchors.end());
  return out;
}

/// Rounding of products of a few probabilities.
constexpr double kRounding = 1e-12;

TEST(Factorise, FactorsOfAProductAreItsParts) {
  const auto a = set_of({{0.7, {0, 3}}, {0.2, {1, 3}}, {0.1, {2, 4}}});
  const auto b = set_of({{0.6, {0, -1}}, {0.4, {1, 0}}});
  const auto parts = factorise(join(a, b, 0, 0), {0, kRounding, 0});
  ASSERT_EQ(groups(parts), (std::vector<std::vector<int>>{{0, 1}, {2, 3}}));
  ASSERT_EQ(parts[1].hypotheses.size(), 2u);
  EXPECT_NEAR(std::exp(parts[1].hypotheses[0].log_weight), 0.6, kRounding);
  EXPECT_NEAR(std::exp(parts[0].hypotheses[2].log_weight), 0.1, kRounding);
}

TEST(Factorise, AProductThatWasCutIsCompleted) {
  const auto a = set_of({{0.9, {0}}, {0.08, {1}}, {0.02, {2}}});
  const auto b = set_of({{0.95, {0}}, {0.04, {1}}, {0.01, {2}}});
  const auto cut = join(a, b, 5, 0);
  const auto parts = factorise(cut, {std::exp(cut.back().log_weight), 1e-6, 0});
  ASSERT_EQ(groups(parts), (std::vector<std::vector<int>>{{0}, {1}}));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(parts[0].hypotheses[i].log_weight, a[i].log_weight, kRounding);
    EXPECT_NEAR(parts[1].hypotheses[i].log_weight, b[i].log_weight, kRounding);
  }
}

TEST(Factorise, AnAnchorThatNeverVariesStandsAlone) {
  const auto set = set_of({{0.6, {0, 2, 0}}, {0.4, {1, 2, 1}}});
  EXPECT_EQ(groups(factorise(set, {0, kRounding, 0})),
            (std::vector<std::vector<int>>{{0, 2}, {1}}));
}

TEST(Factorise, ChangesThatExcludeEachOtherStayTogether) {
  const auto set = set_of({{0.8, {0, 0}}, {0.1, {1, 0}}, {0.1, {0, 1}}});
  EXPECT_EQ(factorise(set, {0, kRounding, 0}).size(), 1u);
  // 0.1 * 0.1 / 0.8 may be missing because it lay below a floor of 0.01.
  EXPECT_EQ(factorise(set, {0.01, kRounding, 0}).size(), 2u);
}

TEST(Factorise, WhatDependsOnlyInThreesStaysTogether) {
  // Parity: any two are independent, the three are not.
  const auto set = set_of({{1, {0, 0, 0}}, {1, {0, 1, 1}}, {1, {1, 0, 1}}, {1, {1, 1, 0}}});
  EXPECT_EQ(factorise(set, {0, kRounding, 0}).size(), 1u);
}

}  // namespace
}  // namespace anchord
