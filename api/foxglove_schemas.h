#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace anchord::foxglove {

/// The JSON Schema of what is said in foxglove.SceneUpdate, foxglove.PoseInFrame or foxglove.Log:
/// by the names and types of https://github.com/foxglove/foxglove-sdk, schemas/jsonschema.
nlohmann::json schema_of(const std::string& name);

}  // namespace anchord::foxglove
