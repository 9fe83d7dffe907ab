#pragma once

#include "anchoring/belief.h"

namespace anchord {

/// Objects that go by other names in other worlds keep those that are shown until the others are so
/// many times as probable: what keeps the wrong names for long seldom gets the right ones again
/// without a change more. Chosen on simulated crowds that are seen once a second (docs/figures.md,
/// "Crowds"); at 30 Hz up to 30 it hardly matters.
inline constexpr double kClearlyOther = 3;

/// Chooses the hypothesis of a cluster that the best world shows: the most probable one, unless
/// that is the world shown so far but for its names. Where two like objects have met and parted,
/// worlds in which they have kept and exchanged their names stay about equally probable for long;
/// so do worlds in which one object goes by the name of its first detection and of its second. They
/// take turns at the top, and names that follow them call an object now this, now that. So a world
/// that gives the objects shown so far (AnchorTree::shown) other names must outweigh the one that
/// keeps them clearly. Sets Cluster::leading and the trees' `shown`.
void choose_leading(Cluster& cluster, const Background& background);

}  // namespace anchord
