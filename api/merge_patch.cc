#include "api/merge_patch.h"

namespace anchord {

using nlohmann::json;

std::optional<json> merge_patch(const json& from, const json& to) {
  if (from == to) return std::nullopt;
  if (!from.is_object() || !to.is_object()) return to;
  json patch = json::object();
  for (const auto& [name, value] : from.items())
    if (!to.contains(name)) patch[name] = nullptr;
  for (const auto& [name, value] : to.items()) {
    const auto before = from.find(name);
    if (before == from.end())
      patch[name] = value;
    else if (auto change = merge_patch(*before, value))
      patch[name] = *std::move(change);
  }
  return patch;
}

}  // namespace anchord
