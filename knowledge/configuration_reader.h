#pragma once

#include <nlohmann/json.hpp>

#include "knowledge/configuration.h"
#include "knowledge/json_reader.h"

namespace anchord {

/// Turns a configuration with its includes merged in into knowledge. Where mistakes are noted the
/// knowledge is not to be used. Each part below may rely on those before it.
Knowledge read_knowledge(const nlohmann::json& document, ConfigurationMistakes& mistakes);

/// The parts; `root` is the whole document.
void read_world(const JsonValue& root, Knowledge& knowledge);
void read_places(const JsonValue& root, Knowledge& knowledge);
void read_attributes(const JsonValue& root, Knowledge& knowledge);
void read_classes(const JsonValue& root, Knowledge& knowledge);
void read_sensors(const JsonValue& root, Knowledge& knowledge);
void read_maintenance(const JsonValue& root, Knowledge& knowledge);
void read_limits(const JsonValue& root, Knowledge& knowledge);
void read_log_limits(const JsonValue& root, Knowledge& knowledge);

/// A model with the parameters that hold where the configuration gives none.
BehaviourModel default_model(BehaviourModel::Kind kind);

/// The behaviour models of a class (the value of `models`), weights normalised.
std::vector<BehaviourModel> read_models(const JsonValue& value, const Knowledge& knowledge);

/// How the attributes of a class change (the value of `changes`).
std::vector<AttributeChange> read_changes(const JsonValue& value, const Knowledge& knowledge);

/// A number, or [p, c] for one that depends on the distance.
std::optional<DetectionProbability> read_detection_probability(const JsonValue& value);

/// A distribution over `symbols` (an object): what it leaves goes evenly to those it does not
/// name. Normalised.
std::optional<std::vector<double>> read_distribution(const JsonValue& value,
                                                     const std::vector<std::string>& symbols);

/// A sensor's view, in the shape that a frame gives it.
std::optional<View> read_view(const JsonValue& value, int dims);

/// How a sensor serves verification tasks: what `value` says, and else as it is.
void read_verification(const JsonValue& value, const Knowledge& knowledge,
                       Verification& verification);

/// Fills in the sensor's own noise; notes what a sensor (`value`) for tasks lacks.
void finish_verification(const JsonValue& value, Sensor& sensor);

std::vector<std::string> names(const std::vector<Place>& places);

}  // namespace anchord
