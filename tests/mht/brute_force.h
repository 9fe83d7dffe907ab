#pragma once

#include <algorithm>
#include <vector>

#include "core/log_probability.h"
#include "mht/ranked_associations.h"

namespace anchord::testing {

/// Every association of a problem by recursion over the detections, best first.
inline std::vector<Association> every_association(const AssociationProblem& problem) {
  std::vector<Association> out;
  for (int p = 0; p < static_cast<int>(problem.parents.size()); ++p) {
    const auto& parent = problem.parents[p];
    std::vector<int> leaf_of(problem.detections, Association::kNone);
    std::vector<char> used(parent.leaves.size(), 0);
    const auto recurse = [&](const auto& self, int z, double weight) -> void {
      if (z == problem.detections) {
        out.push_back({p, weight, {leaf_of.begin(), leaf_of.end()}});
        return;
      }
      leaf_of[z] = Association::kNone;
      self(self, z + 1, weight);
      for (std::size_t l = 0; l < parent.leaves.size(); ++l) {
        for (const auto& gain : problem.gains[parent.leaves[l]]) {
          if (used[l] || gain.detection != z) continue;
          used[l] = 1;
          leaf_of[z] = parent.leaves[l];
          self(self, z + 1, weight + gain.log_gain);
          used[l] = 0;
        }
      }
    };
    recurse(recurse, 0, parent.log_weight);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.log_weight > b.log_weight; });
  return out;
}

}  // namespace anchord::testing
