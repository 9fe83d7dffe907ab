#include <algorithm>

#include "knowledge/configuration_reader.h"

namespace anchord {
namespace {

constexpr std::size_t kMostModels = 20;
const std::vector<std::string> kKinds = {"constant_position", "constant_velocity", "somewhere"};

/// What a model says of its motion, in height times `vertical`.
void read_by_axis(const JsonValue& value, const char* key, ByAxis& number) {
  double plane = number.plane, vertical = 1;
  value.read(key, plane, kNotNegative);
  value.read("vertical", vertical, kNotNegative);
  number = {plane, vertical * plane};
}

void read_shared_detection(const JsonValue& value, const Knowledge& knowledge,
                           BehaviourModel& model) {
  const auto shared = value.find("shared_detection");
  if (!shared || !shared->object_of({"probability", "reach", "stir", "size"})) return;
  model.shared_probability = 0.99;
  shared->read("probability", model.shared_probability, kBelowCertain);
  if (!shared->find("reach")) shared->mistake_at(shared->path_of("reach"), "is missing");
  shared->read("reach", model.reach, kPositive);
  shared->read("stir", model.stir, kRate);
  const auto size = shared->find("size");
  if (!size) return;
  std::vector<std::string> known;
  for (const Attribute& attribute : knowledge.attributes) known.push_back(attribute.name);
  model.growing = size->one_of(known, "attribute").value_or(-1);
  if (model.growing < 0 || knowledge.attributes[model.growing].kind == Attribute::Kind::kScalar)
    return;
  size->mistake("must be a scalar attribute");
}

/// One model; `weighted` becomes true where it has an `initial_weight`.
std::optional<BehaviourModel> read_model(const JsonValue& value, const Knowledge& knowledge,
                                         bool& weighted) {
  if (!value.object()) return std::nullopt;
  const auto kind = value.find("kind");
  if (!kind) {
    value.mistake_at(value.path_of("kind"), "is missing; it must be \"" + kKinds[0] + "\", \"" +
                                                kKinds[1] + "\" or \"" + kKinds[2] + "\"");
    return std::nullopt;
  }
  const auto index = kind->one_of(kKinds, "behaviour model");
  if (!index) return std::nullopt;
  BehaviourModel model = default_model(static_cast<BehaviourModel::Kind>(*index));
  switch (model.kind) {
    case BehaviourModel::Kind::kConstantPosition:
      value.object_of(
          {"kind", "position_psd", "vertical", "initial_weight", "detectable", "shared_detection"});
      read_by_axis(value, "position_psd", model.psd);
      read_shared_detection(value, knowledge, model);
      break;
    case BehaviourModel::Kind::kConstantVelocity:
      value.object_of({"kind", "acceleration_psd", "initial_velocity_variance", "vertical",
                       "initial_weight", "detectable"});
      read_by_axis(value, "acceleration_psd", model.psd);
      read_by_axis(value, "initial_velocity_variance", model.initial_velocity_variance);
      break;
    case BehaviourModel::Kind::kSomewhere:
      value.object_of(
          {"kind", "place", "rate", "stir", "found_in", "initial_weight", "detectable"});
      if (const auto place = value.find("place")) {
        model.place = place->one_of(names(knowledge.places), "place").value_or(-1);
      }
      value.read("rate", model.rate, kRate);
      value.read("stir", model.stir, kRate);
      break;
  }
  value.read("detectable", model.detectable);

  weighted = value.find("initial_weight").has_value();
  value.read("initial_weight", model.initial_weight, kNotNegative);
  return model;
}

/// The first tracked model weighs 1 where nothing else is said of it.
void weigh(const JsonValue& value, const std::vector<char>& weighted,
           std::vector<BehaviourModel>& models) {
  const auto first = std::find_if(models.begin(), models.end(),
                                  [](const BehaviourModel& model) { return model.tracked(); });
  if (first == models.end()) return;  // noted by read_models()
  if (!weighted[static_cast<std::size_t>(first - models.begin())]) first->initial_weight = 1;
  double sum = 0;
  for (const BehaviourModel& model : models) sum += model.initial_weight;
  if (!(sum > 0)) value.mistake("at least one initial_weight must be above 0");
  for (BehaviourModel& model : models) model.initial_weight /= sum > 0 ? sum : 1;
}

bool is_found_in(const BehaviourModel& model) {
  return model.tracked() && model.detectable && !model.shares();
}

/// Which model what was somewhere is in once it has been found: known when all models are.
void read_found_in(const JsonValue& value, std::vector<BehaviourModel>& models, std::size_t of) {
  const auto found_in = value.find("found_in");
  const auto index =
      found_in ? found_in->integer(0, static_cast<int>(models.size()) - 1) : std::nullopt;
  if (!index) return;
  models[of].found_in = *index;
  if (!is_found_in(models[static_cast<std::size_t>(*index)]))
    found_in->mistake("must be a tracked model that is detectable and shares no detections");
}

}  // namespace

BehaviourModel default_model(BehaviourModel::Kind kind) {
  BehaviourModel model;
  model.kind = kind;
  switch (kind) {
    case BehaviourModel::Kind::kConstantPosition:
      model.psd = 0.001;
      break;
    case BehaviourModel::Kind::kConstantVelocity:
      model.psd = 0.1;
      model.initial_velocity_variance = 0.01;
      break;
    case BehaviourModel::Kind::kSomewhere:
      model.rate = 0.001;
      break;
  }
  return model;
}

std::vector<BehaviourModel> read_models(const JsonValue& value, const Knowledge& knowledge) {
  std::vector<BehaviourModel> models;
  std::vector<char> weighted;  // whether a model says its initial weight
  bool all_read = value.json().is_array();
  for (const JsonValue& entry : value.elements(kMostModels)) {
    bool says_weight = false;
    if (auto model = read_model(entry, knowledge, says_weight)) {
      models.push_back(*model);
      weighted.push_back(says_weight);
    } else {
      all_read = false;
    }
  }
  if (!all_read) return models;
  std::size_t m = 0;
  for (const JsonValue& entry : value.elements(kMostModels)) read_found_in(entry, models, m++);
  if (std::none_of(models.begin(), models.end(), is_found_in)) {
    value.mistake(
        "needs a constant_position or constant_velocity model that is detectable and shares no "
        "detections");
  }
  weigh(value, weighted, models);
  return models;
}

}  // namespace anchord
