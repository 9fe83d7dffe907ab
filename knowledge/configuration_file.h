#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "knowledge/configuration.h"

namespace anchord {

/// A configuration file as one JSON document, with what it includes merged in below it; nothing
/// and at least one mistake where a file cannot be read or is no JSON. Throws nothing of JSON's.
std::optional<nlohmann::json> load_document(const std::filesystem::path& file,
                                            ConfigurationMistakes& mistakes);

/// The same from memory; see parse_configuration().
std::optional<nlohmann::json> load_document(std::string_view text,
                                            const std::filesystem::path& directory,
                                            ConfigurationMistakes& mistakes);

}  // namespace anchord
