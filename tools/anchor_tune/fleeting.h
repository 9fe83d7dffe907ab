#pragma once

#include <optional>
#include <vector>

#include "tools/anchor_tune/chain.h"

namespace anchord::tuning {

/// How one kind of phantom lasts: it is visible or hidden as objects are (chain.h), and leaves at a
/// constant rate.
struct Fleeting {
  Estimate share;                  ///< of the chains: those of this kind
  Estimate detection_probability;  ///< while it is there and not hidden
  Estimate departure;              ///< 1/s
  bool hidden = false;             ///< whether it hides at all
  Estimate hide, show;             ///< 1/s
};

/// Looks at false things after the first detection of each.
using Looks = std::vector<Glance>;

struct FleetingKinds {
  std::vector<Fleeting> kinds;  ///< those that are found most surely first
  double gain = 0;              ///< in log-likelihood, of hidden states over none

  /// P(of each kind | its looks); what is left of 1: that it was clutter, of which no more is seen.
  std::vector<double> shares(const Looks& looks) const;
};

/// The most likely `count` kinds beside clutter, by expectation and maximisation (Dempster, Laird,
/// Rubin 1977); hidden states where the Bayesian information criterion prefers them. Nothing if
/// nothing was found again. Intervals from the curvature of the whole likelihood.
std::optional<FleetingKinds> fit_fleeting(const std::vector<Looks>& chains, int count);

}  // namespace anchord::tuning
