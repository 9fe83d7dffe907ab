#pragma once

#include <Eigen/Core>
#include <map>
#include <string>

#include "core/result.h"

namespace anchord {

/// Where people truly were: by person, by the video's frame (from 1), m on the ground.
using Truth = std::map<int, std::map<int, Eigen::Vector2d>>;

/// Reads lines `frame,id,x,y,...` after a line of titles; what follows is not looked at.
Result<Truth> read_truth(const std::string& file);

}  // namespace anchord
