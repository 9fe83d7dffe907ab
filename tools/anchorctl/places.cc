#include "tools/anchorctl/places.h"

#include <algorithm>
#include <vector>

#include "tools/anchorctl/format.h"
#include "tools/anchorctl/table.h"

namespace anchord {
namespace {

constexpr double kInformative = 0.05;  ///< a part with less is not named for itself
constexpr double kVisible = 0.005;     ///< what two decimals show
constexpr int kOutside = -1;           ///< the parent of a place that lies in no other

struct Place {
  std::string name;
  double p = 0;
  std::string parent_name;
  int parent = kOutside;
  int depth = 0;
  double named = 0;  ///< its mass that parts inside it have taken already
};

std::string part(const std::string& name, double p) { return glued(name + " " + probability(p)); }

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const auto& each : parts) text += (text.empty() ? "" : ", ") + each;
  return text.empty() ? "-" : text;
}

void link(std::vector<Place>& all) {
  const auto count = static_cast<int>(all.size());
  for (Place& place : all) {
    for (int i = 0; i < count; ++i) {
      const auto& other = all[static_cast<std::size_t>(i)];
      if (&other != &place && other.name == place.parent_name) place.parent = i;
    }
  }
  for (Place& place : all) {
    int at = place.parent;
    for (; at != kOutside && place.depth <= count; ++place.depth) {
      at = all[static_cast<std::size_t>(at)].parent;
    }
    if (at != kOutside) place.parent = kOutside, place.depth = 0;  // they go round in a circle
  }
}

std::string deepest(std::vector<Place> all) {
  link(all);
  std::vector<Place*> inside_first;
  for (Place& place : all) inside_first.push_back(&place);
  std::stable_sort(inside_first.begin(), inside_first.end(),
                   [](const Place* a, const Place* b) { return a->depth > b->depth; });
  std::vector<std::pair<double, std::string>> parts;
  double elsewhere = 1;
  for (Place* place : inside_first) {
    const double rest = place->p - place->named;
    if (rest >= kInformative) {
      parts.emplace_back(rest, (place->named > 0 ? "rest of " : "") + place->name);
      place->named = place->p;
    }
    if (place->parent == kOutside) {
      elsewhere -= place->named;
    } else {
      all[static_cast<std::size_t>(place->parent)].named += place->named;
    }
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> written;
  for (const auto& [p, name] : parts) written.push_back(part(name, p));
  if (elsewhere >= kVisible) written.push_back(part("elsewhere", elsewhere));
  return joined(written);
}

}  // namespace

std::string places(const Json& entries) {
  std::vector<Place> all;
  bool nested = false;
  double outside = 0, sum = 0;
  for (const Json& entry : entries) {
    const double p = number(entry, "p").value_or(0);
    sum += p;
    nested |= entry.is_object() && entry.contains("parent");
    if (member(entry, "place")) {
      Place place;
      place.name = text(entry, "place");
      place.p = p;
      place.parent_name = text(entry, "parent", "");
      all.push_back(std::move(place));
    } else {
      outside += p;
    }
  }
  if (nested || sum <= 1 + kVisible) return deepest(std::move(all));
  std::vector<std::string> written;
  for (const Place& place : all) {
    if (place.p >= kInformative) written.push_back(part(place.name, place.p));
  }
  if (outside >= kVisible) written.push_back(part("elsewhere", outside));
  return joined(written);
}

}  // namespace anchord
