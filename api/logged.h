#pragma once

#include "anchoring/world.h"
#include "core/result.h"
#include "knowledge/logged_frame.h"

namespace anchord {

/// What stands in the log, decoded: what a world took.
Result<Accepted> read_logged(const LoggedFrame& logged);

/// Applies it, as it was applied before.
Status apply(World& world, const Accepted& accepted);

}  // namespace anchord
