#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace anchord {

/// The name among `known` that `name` was probably meant to be: the one with the fewest typing
/// slips (a letter too many, too few, wrong, or swapped with the next; upper and lower case are
/// alike), if they are at most a third of its letters; else empty.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// The end of a refusal of `name`: `did you mean "table"?`, or else what there is to choose from
/// (`there are: "bed", "table"`), or `there are none`.
std::string suggestion(std::string_view name, const std::vector<std::string>& known);

}  // namespace anchord
