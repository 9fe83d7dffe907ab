#pragma once

#include "lcmtypes/field.h"
#include "lcmtypes/walk.h"

namespace anchord {

/// The walks over what several messages hold. They return what Walk's steps do.

/// A pose_t.
bool walk_pose(Walk& walk, const Field& pose);

/// A count of attribute_t, and these.
bool walk_attributes(Walk& walk, const Field& count, const Field& list);

/// A frame_t. If it is not `used`, its sensor may be empty, as in a message nobody filled.
bool walk_frame(Walk& walk, const Field& frame, bool used = true);

}  // namespace anchord
