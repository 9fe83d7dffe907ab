#include <algorithm>

#include "anchoring/map_event.h"

namespace anchord {
namespace {

using Kind = Event::Kind;

const Anchor& anchor_at(const Belief& belief, const AnchorPlace& at) {
  return *belief.clusters[at.cluster]->anchors[at.anchor].anchor;
}

Error conflict(const char* field, std::string message) {
  return {ErrorCode::kConflict, field, std::move(message)};
}

bool concerns(const SetAside& kept, std::uint64_t birth) {
  const auto is = [&](const auto& cluster) { return cluster->anchors[0].anchor->birth == birth; };
  return kept.birth == birth || std::any_of(kept.anchors.begin(), kept.anchors.end(), is);
}

bool share_an_object(const SetAside& a, const SetAside& b) {
  if (a.birth > 0 && concerns(b, a.birth)) return true;
  return std::any_of(a.anchors.begin(), a.anchors.end(), [&](const auto& cluster) {
    return concerns(b, cluster->anchors[0].anchor->birth);
  });
}

/// Whether an anchor other than that one is called so.
bool is_taken(const std::string& alias, std::uint64_t birth, const Belief& belief) {
  const auto other = find_anchor(belief, alias);
  return other && anchor_at(belief, *other).birth != birth;
}

Status check_undo(std::int64_t number, const Belief& belief) {
  const auto kept = std::find_if(belief.set_aside.begin(), belief.set_aside.end(),
                                 [&](const SetAside& k) { return k.number == number; });
  if (kept == belief.set_aside.end())
    return Error{ErrorCode::kUnknown, "number",
                 "is not one of the last events that can be undone (named, joined, dropped)"};
  const auto later = std::find_if(kept + 1, belief.set_aside.end(),
                                  [&](const SetAside& k) { return share_an_object(*kept, k); });
  if (later != belief.set_aside.end())
    return conflict("number", "cannot be undone before event " + std::to_string(later->number) +
                                  ", a later one about the same object");
  if (kept->birth > 0 && !find_anchor(belief, kept->birth))
    return conflict("number", "cannot be undone: its object is no longer believed in");
  std::vector<std::string> back{kept->alias.value_or("")};
  for (const auto& cluster : kept->anchors) back.push_back(cluster->anchors[0].anchor->alias);
  for (const std::string& alias : back)
    if (is_taken(alias, kept->birth, belief))
      return conflict("number",
                      "cannot be undone: '" + alias + "' is what another object is called now");
  return Done{};
}

}  // namespace

Status check_against(const MapEvent& event, const Belief& belief) {
  const Event& e = event.event;
  if (e.kind == Kind::kUndone) return check_undo(e.undone, belief);
  if (e.kind == Kind::kCarried) return Done{};
  const auto unknown = [](const char* field, const std::string& called) {
    return Error{ErrorCode::kUnknown, field, "no object is called '" + called + "'"};
  };
  const auto object = find_anchor(belief, e.object);
  if (!object) return unknown("object", e.object);
  const std::uint64_t birth = anchor_at(belief, *object).birth;
  if (e.kind == Kind::kJoined) {
    const auto other = find_anchor(belief, e.other);
    if (!other) return unknown("other", e.other);
    if (anchor_at(belief, *other).birth == birth)
      return conflict("other", "is the same object already");
  }
  if (e.kind == Kind::kNamed && is_taken(e.other, birth, belief))
    return conflict("name", "is what another object is called");
  return Done{};
}

std::optional<AnchorPlace> find_anchor(const Belief& belief, std::string_view called) {
  if (called.empty()) return std::nullopt;
  for (std::size_t c = 0; c < belief.clusters.size(); ++c)
    for (std::size_t a = 0; a < belief.clusters[c]->anchors.size(); ++a)
      if (belief.clusters[c]->anchors[a].anchor->is_called(called))
        return AnchorPlace{c, static_cast<int>(a)};
  return std::nullopt;
}

std::optional<AnchorPlace> find_anchor(const Belief& belief, std::uint64_t birth) {
  for (std::size_t c = 0; c < belief.clusters.size(); ++c)
    for (std::size_t a = 0; a < belief.clusters[c]->anchors.size(); ++a)
      if (belief.clusters[c]->anchors[a].anchor->birth == birth)
        return AnchorPlace{c, static_cast<int>(a)};
  return std::nullopt;
}

}  // namespace anchord
