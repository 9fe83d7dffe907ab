#pragma once

#include "anchoring/belief.h"

namespace anchord {

/// An object that goes by another name in other worlds, and nobody else by its own, keeps the one
/// that is shown until the other is so many times as probable: the name that is kept has less than
/// half of the probability then, and many look only at what has more.
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
