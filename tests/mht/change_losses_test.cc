// What a change costs, against every assignment there is.

#include "mht/change_losses.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <functional>
#include <limits>

namespace anchord {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Problem {
  PairGains gains;
  std::vector<std::vector<PairGains::Entry>> rows;
};

Problem problem_of(int detections, int leaves) {
  Problem out{PairGains(detections, leaves), {}};
  for (int z = 0; z < detections; ++z) {
    out.gains.start_row();
    auto& row = out.rows.emplace_back();
    for (int leaf = 0; leaf < leaves; ++leaf)
      if (*rc::gen::inRange(0, 3) > 0) {
        const double gain = *rc::gen::inRange(-200, 600) / 100.0;
        out.gains.add(leaf, gain);
        row.push_back({leaf, gain});
      }
  }
  return out;
}

/// Calls `each(choices, gain)` for every assignment.
void for_all(const Problem& problem, std::vector<int>& choices, double gain,
             const std::function<void(const std::vector<int>&, double)>& each) {
  const std::size_t z = choices.size();
  if (z == problem.rows.size()) return each(choices, gain);
  choices.push_back(Assignment::kNone);
  for_all(problem, choices, gain, each);
  for (const auto& [leaf, its_gain] : problem.rows[z]) {
    if (std::find(choices.begin(), choices.end() - 1, leaf) != choices.end() - 1) continue;
    choices.back() = leaf;
    for_all(problem, choices, gain + its_gain, each);
  }
  choices.pop_back();
}

RC_GTEST_PROP(ChangeLosses, AreWhatTheBestAssignmentWithThatPairLoses, ()) {
  const Scratch scratch;
  const Problem problem = problem_of(*rc::gen::inRange(1, 6), *rc::gen::inRange(1, 6));
  const Assignment best(problem.gains);
  const double reach = *rc::gen::element(0.5, 2.0, 5.0, 1e9);
  const ChangeLosses losses(problem.gains, best, reach);
  const int n = problem.gains.detections();
  const double most = best.gain(problem.gains);
  int within = 0;
  for (int z = 0; z < n; ++z) {
    const auto least_of = [&](int choice) {
      double least = kInfinite;
      std::vector<int> choices;
      for_all(problem, choices, 0, [&](const std::vector<int>& all, double gain) {
        if (all[z] == choice) least = std::min(least, most - gain);
      });
      return least;
    };
    const auto expect = [&](double loss, int choice) {
      const double expected = least_of(choice);
      if (choice == best.choice(z)) {
        RC_ASSERT(loss == 0);
      } else if (std::abs(expected - reach) > 1e-9) {  // on the edge either is right
        RC_ASSERT((loss <= reach) == (expected <= reach));
        if (expected <= reach) {
          RC_ASSERT(std::abs(loss - expected) < 1e-9);
        }
      }
      within += choice != best.choice(z) && loss <= reach ? 1 : 0;
    };
    expect(losses.of_none(z), Assignment::kNone);
    for (std::size_t i = 0; i < problem.rows[z].size(); ++i)
      expect(losses.of(z, i), problem.rows[z][i].leaf);
  }
  RC_ASSERT(losses.within_reach() == within);
}

}  // namespace
}  // namespace anchord
