#pragma once

#include <nlohmann/json.hpp>
#include <optional>

namespace anchord {

/// The JSON merge patch (RFC 7396) that makes `to` of `from`: members that differ, null for those
/// that are gone; arrays are replaced whole. Neither may hold a null. Nothing where they are equal.
std::optional<nlohmann::json> merge_patch(const nlohmann::json& from, const nlohmann::json& to);

}  // namespace anchord
