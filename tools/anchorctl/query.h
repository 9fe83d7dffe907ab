#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/result.h"

namespace anchord {

/// Name and value of each query parameter, in the order in which they were given.
using Parameters = std::vector<std::pair<std::string, std::string>>;

/// Reads what is left of a command line: `cup`, `cup-12`, `color=blue`, `--place kitchen`,
/// `--min-p=0.5`. One bare word may be among them: the id of an object if it ends in a dash and a
/// number, else a class. A dash inside the name of an option is an underscore.
/// Refused: a second bare word, a parameter given twice, an option without its value.
Result<Parameters> parse_words(const std::vector<std::string>& words);

/// The value of `name`; nullptr if it is not there.
const std::string* find_parameter(const Parameters& parameters, const std::string& name);

/// The request target of a command: `/v1/where?class=cup&color=light%20blue`. For `objects` an
/// object's id is part of the path: `/v1/objects/cup-1`.
std::string make_target(const std::string& command, Parameters parameters);

/// `class=cup&color=light%20blue`.
std::string make_query(const Parameters& parameters);

}  // namespace anchord
