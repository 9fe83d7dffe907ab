// What association costs: assignments, ranking them, and taking sets of hypotheses apart.

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "bench/crowd.h"
#include "mht/assignment.h"
#include "mht/factors.h"
#include "mht/hypothesis_set.h"
#include "mht/ranked_associations.h"

namespace anchord::bench {
namespace {

void BM_Assignment(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Dice dice(1);
  PairGains gains(n, n);
  for (int z = 0; z < n; ++z) {
    gains.start_row();
    for (int leaf = 0; leaf < n; ++leaf) gains.add(leaf, dice.uniform(0, 10));
  }
  for (auto _ : state) {
    const Scratch scratch;
    const Assignment assignment(gains);
    benchmark::DoNotOptimize(assignment.choice(0));
  }
}
BENCHMARK(BM_Assignment)->Arg(3)->Arg(10)->Arg(30);

/// Eight anchors with three leaves each, of which every parent takes one; a leaf may be given most
/// detections, none of them for sure.
AssociationProblem ambiguous_problem(int parents, int detections) {
  constexpr int kAnchors = 8, kLeaves = 3;
  Dice dice(2);
  AssociationProblem problem;
  problem.detections = detections;
  problem.gains.resize(kAnchors * kLeaves);
  for (auto& gains : problem.gains)
    for (int z = 0; z < detections; ++z)
      if (!dice.chance(0.3)) gains.push_back({z, dice.uniform(-4, 6)});
  for (int p = 0; p < parents; ++p) {
    AssociationProblem::Parent parent;
    parent.log_weight = -0.05 * p;
    for (int a = 0; a < kAnchors; ++a)
      parent.leaves.push_back(a * kLeaves + static_cast<int>(dice.index(kLeaves)));
    problem.parents.push_back(std::move(parent));
  }
  return problem;
}

/// The 100 best of 100 parents and 5 detections.
void BM_RankedAssociations(benchmark::State& state) {
  constexpr int kBest = 100;
  const AssociationProblem problem = ambiguous_problem(100, 5);
  for (auto _ : state) {
    const Scratch scratch;
    RankedAssociations ranked(problem);
    for (int i = 0; i < kBest; ++i) {
      auto association = ranked.next();
      if (!association) {
        state.SkipWithError("fewer associations than asked for");
        break;
      }
      benchmark::DoNotOptimize(association);
    }
  }
}
BENCHMARK(BM_RankedAssociations);

/// One parent: as many leaves as detections, each of which may be given `pairs` of them (all:
/// dense).
AssociationProblem square_problem(int n, int pairs, std::uint64_t seed) {
  Dice dice(seed);
  AssociationProblem problem;
  problem.detections = n;
  problem.gains.resize(n);
  problem.parents.push_back({0, {}});
  for (int leaf = 0; leaf < n; ++leaf) {
    problem.parents[0].leaves.push_back(leaf);
    std::vector<char> has(n, pairs >= n);
    for (int i = 0; i < pairs && pairs < n;) {
      char& one = has[dice.index(n)];
      i += one ? 0 : 1;
      one = 1;
    }
    for (int z = 0; z < n; ++z)
      if (has[z]) problem.gains[leaf].push_back({z, dice.uniform(0, 10)});
  }
  return problem;
}

/// The 100 best of a square problem, from its gains on.
void BM_HundredBest(benchmark::State& state) {
  const auto problem =
      square_problem(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), 4);
  for (auto _ : state) {
    const Scratch scratch;
    RankedAssociations ranked(problem);
    for (int i = 0; i < 100; ++i) benchmark::DoNotOptimize(ranked.next());
  }
}
BENCHMARK(BM_HundredBest)->Args({100, 3})->Args({50, 50});

/// Some anchors with two leaves each, all combinations, weights at random: nothing in it is
/// independent.
HypothesisSet dependent_set(int anchors, Dice& dice) {
  HypothesisSet set(std::size_t{1} << anchors);
  for (std::size_t i = 0; i < set.size(); ++i) {
    set[i].log_weight = dice.uniform(-6, 0);
    for (int a = 0; a < anchors; ++a) set[i].leaf.push_back(static_cast<int>(i >> a & 1));
  }
  normalise(set);
  return set;
}

constexpr int kMost = 100;

/// The 100 best of the product of three sets.
HypothesisSet product_set() {
  Dice dice(3);
  const HypothesisSet a = dependent_set(3, dice), b = dependent_set(3, dice),
                      c = dependent_set(2, dice);
  return join(join(a, b, 0, 0), c, kMost, 0);
}

void BM_Join(benchmark::State& state) {
  Dice dice(3);
  const HypothesisSet a = dependent_set(6, dice), b = dependent_set(6, dice);
  for (auto _ : state) benchmark::DoNotOptimize(join(a, b, kMost, 1e-6));
}
BENCHMARK(BM_Join);

/// A set that has been cut to its best, as the engine takes it apart after a frame.
void BM_Factorise(benchmark::State& state) {
  const HypothesisSet set = product_set();
  const Cut cut{std::exp(set.back().log_weight), 1e-4, 0.05};
  std::size_t factors = 0;
  for (auto _ : state) {
    const auto found = factorise(set, cut);
    factors = found.size();
    benchmark::DoNotOptimize(found.data());
  }
  state.counters["hypotheses"] = static_cast<double>(set.size());
  state.counters["factors"] = static_cast<double>(factors);
}
BENCHMARK(BM_Factorise);

}  // namespace
}  // namespace anchord::bench
