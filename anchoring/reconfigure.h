#pragma once

#include "anchoring/world.h"

namespace anchord {

/// A world of another knowledge that goes on from what this one believes (docs/belief.md, "A
/// changed configuration"). Classes, attributes, symbols and places are the same ones where they
/// have the same name. The belief's time, anchors, hypotheses and counts stay, and with them every
/// object's probability; WorldState::floor is the belief's utime, and nothing before it is folded
/// again. Of the same knowledge it goes on as the world itself would, to the bit.
///
/// Refuses what takes away something in use, which changes nothing; kConflict, `field` is the path
/// in the configuration: `world.dimensions` while there is any anchor; `attributes.NAME`, taken
/// away or of another kind, that a leaf holds; `attributes.NAME.symbols` without one that is the
/// most probable of some leaf; `classes.NAME`, taken away, that is the most probable of some leaf
/// or that objects have been named after, or new where an alias looks like its names.
Result<World> reconfigured(const World& world, Knowledge knowledge);
/// The same; `empty` is a world of the new knowledge, whose Background the result shares.
Result<World> reconfigured(const World& world, const World& empty);

}  // namespace anchord
