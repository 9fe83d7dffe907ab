#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/time.h"

namespace anchord {

/// Reading the daemon's answers: what is missing, null or of another type reads as nothing, so
/// that a newer or older daemon is still understood. None of these throws.
using Json = nlohmann::json;

/// The member `name` of `object`; nullptr if it is missing or null, or `object` is no object.
const Json* member(const Json& object, const char* name);

std::optional<double> number(const Json& object, const char* name);
std::optional<Utime> utime(const Json& object, const char* name);
/// True only for a JSON true.
bool flag(const Json& object, const char* name);
/// The string, safe to print; `missing` if there is none.
std::string text(const Json& object, const char* name, const std::string& missing = "-");
/// The array or the object; an empty array if there is none.
const Json& items(const Json& object, const char* name);
/// The numbers of an array; empty if one of them is none.
std::vector<double> numbers(const Json& object, const char* name);

/// `text` with '?' in the place of control characters: nothing that comes over the network steers
/// a terminal, and a line stays a line.
std::string printable(const std::string& text);

}  // namespace anchord
