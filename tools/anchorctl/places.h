#pragma once

#include <string>

#include "tools/anchorctl/fields.h"

namespace anchord {

/// Where something is, from [{"place": name|null, "p", "parent"?}]: the deepest places with enough
/// of the mass, as parts that sum to 1: "kitchen_table 0.68, rest of kitchen 0.12, elsewhere 0.20".
/// Mass too thin to be named for itself counts for the place around it. Where no entry has a
/// "parent" and the places overlap, they are written as they come, with their own p.
std::string places(const Json& entries);

}  // namespace anchord
