#pragma once

#include <string>

#include "api/answers.h"

namespace anchord {

/// All that there is to ask of a belief, one after the other: equal beliefs give equal bytes.
inline std::string answers(const Snapshot& snapshot) {
  std::string bytes;
  for (const char* target : {"/v1/objects?min_p=0", "/v1/hypotheses", "/v1/count"})
    bytes += answer(*parse_target(target), snapshot).body;
  return bytes;
}

}  // namespace anchord
