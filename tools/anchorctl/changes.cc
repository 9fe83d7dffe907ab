#include "tools/anchorctl/changes.h"

#include <algorithm>
#include <cmath>

#include "tools/anchorctl/format.h"
#include "tools/anchorctl/table.h"

namespace anchord {
namespace {

double distance_m(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    square += (a[i] - b[i]) * (a[i] - b[i]);
  }
  return std::sqrt(square);
}

std::string kind_of(const Json& object) {
  const std::string kind = class_of(object);
  return kind.substr(0, kind.find(glued(" ")));
}

}  // namespace

std::vector<std::string> Changes::update(const Json& answer) {
  std::vector<std::string> lines;
  const std::string when = date_and_time(utime(answer, "utime"));
  const auto tell = [&](const std::string& id, const std::string& what) {
    lines.push_back(when + "  " + id + "  " + what);
  };
  std::map<std::string, Seen> now;
  for (const Json& object : items(answer, "objects")) {
    const std::string id = text(object, "id");
    Seen seen{kind_of(object), text(object, "place"), numbers(object, "position")};
    const std::string at = "at " + position(seen.position_map) + " m";
    const auto old = told_.find(id);
    if (old == told_.end()) {
      tell(id, "appeared: " + seen.kind + ", p " + probability(number(object, "p")) + ", place " +
                   seen.place + ", " + at);
    } else {
      const Seen& before = old->second;
      if (seen.kind != before.kind) tell(id, "class " + before.kind + " -> " + seen.kind);
      const bool moved = distance_m(seen.position_map, before.position_map) > kMoved_m;
      if (seen.place != before.place) {
        tell(id, "place " + before.place + " -> " + seen.place + ", " + at);
      } else if (moved) {
        tell(id, "moved, place " + seen.place + ", " + at);
      } else {
        seen.position_map = before.position_map;
      }
    }
    now.emplace(id, std::move(seen));
  }
  for (const auto& [id, seen] : told_) {
    if (!now.contains(id)) tell(id, "disappeared");
  }
  told_ = std::move(now);
  return lines;
}

}  // namespace anchord
