#pragma once

#include <cstdint>
#include <optional>

#include "anchoring/coupling.h"

namespace anchord {

/// Divides a bound on the work of a frame (see Effort) among groups of clusters, in order: each
/// gets its part of what is left, by its hypotheses and anchors. What one leaves over, later ones
/// get.
class Budget {
 public:
  /// `work`: for all groups together; nothing: no bound.
  Budget(const ScratchVector<Group>& groups, std::optional<std::uint64_t> work,
         const Limits& limits);

  /// What the next group may look at: at least one hypothesis before the frame and one after it.
  Allowance next();
  /// What that group took.
  void take(std::uint64_t work);

 private:
  struct Need {
    double anchors, hypotheses;
  };
  ScratchVector<Need> needs_;
  std::optional<std::uint64_t> left_;
  double needed_ = 0;  // by the groups that are left
  std::size_t group_ = 0;
};

}  // namespace anchord
