#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/anchorctl/fields.h"

namespace anchord {

/// What is new from one answer of `GET /v1/objects` to the next, for output that is no terminal.
class Changes {
 public:
  /// A line (without its end) for each object that appeared, disappeared, changed its class or
  /// place, or is more than kMoved_m from where a line last said it was.
  std::vector<std::string> update(const Json& answer);

  static constexpr double kMoved_m = 0.1;

 private:
  struct Seen {
    std::string kind, place;
    std::vector<double> position_map;
  };
  std::map<std::string, Seen> told_;
};

}  // namespace anchord
