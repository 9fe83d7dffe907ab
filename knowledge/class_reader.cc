#include <algorithm>
#include <set>

#include "knowledge/configuration_reader.h"
#include "knowledge/suggestion.h"

namespace anchord {
namespace {

constexpr std::size_t kMostTransitions = 400, kMostArrivals = 1000;
constexpr double kMostPerMetre = 1000;  // a step, for all purposes

/// The class that `classes.default` starts from; documented at read_configuration().
ObjectClass built_in_class() {
  ObjectClass built_in;
  built_in.models = {default_model(BehaviourModel::Kind::kConstantVelocity),
                     default_model(BehaviourModel::Kind::kSomewhere)};
  built_in.models[0].initial_weight = 1;
  built_in.detection_probability = 0.9;
  built_in.arrival_rate = 1e-4;
  built_in.departure_rate = 0;
  built_in.undetected_intensity = 0.01;
  return built_in;
}

/// The model at one end of a transition: `from` or `to`.
std::optional<int> read_end(const JsonValue& transition, const char* key,
                            const std::vector<BehaviourModel>& models) {
  const auto value = transition.find(key);
  if (!value) {
    transition.mistake_at(transition.path_of(key), "is missing; it must be the index of a model");
    return std::nullopt;
  }
  return value->integer(0, static_cast<int>(models.size()) - 1);
}

std::vector<Transition> read_transitions(const JsonValue& value,
                                         const std::vector<BehaviourModel>& models) {
  std::vector<Transition> transitions;
  std::set<std::pair<int, int>> seen;
  for (const JsonValue& entry : value.elements(kMostTransitions)) {
    if (!entry.object_of({"from", "to", "rate"})) continue;
    const auto from = read_end(entry, "from", models), to = read_end(entry, "to", models);
    Transition transition;
    if (!entry.find("rate")) entry.mistake_at(entry.path_of("rate"), "is missing, 1/s");
    entry.read("rate", transition.rate, kRate);
    if (!from || !to) continue;
    if (*from == *to) entry.mistake("must lead to another model");
    if (!models[static_cast<std::size_t>(*from)].tracked())
      entry.mistake_at(entry.path_of("from"),
                       "is a somewhere model, which is left by a detection only");
    if (!seen.insert({*from, *to}).second) {
      entry.mistake("stands there already: give one rate from one model to another");
    }
    transition.from = *from;
    transition.to = *to;
    transitions.push_back(transition);
  }
  return transitions;
}

/// A member that is a covariance matrix, or nothing.
std::optional<Eigen::Matrix3d> read_covariance(const JsonValue& value, const char* key, int dims) {
  const auto member = value.find(key);
  const auto entries = member ? member->covariance(dims) : std::nullopt;
  if (!entries) return std::nullopt;
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  out.topLeftCorner(dims, dims) = Eigen::Map<const Eigen::MatrixXd>(entries->data(), dims, dims);
  return out;
}

/// How what arrives goes on before it is seen, if it does.
std::optional<Arrival::Motion> read_motion(const JsonValue& value,
                                           const std::vector<BehaviourModel>& models, int dims) {
  bool moves = false;
  value.read("moves", moves);
  for (const char* key : {"velocity", "velocity_covariance", "at_start"})
    if (!moves && value.find(key))
      value.mistake_at(value.path_of(key), "is for arrivals with \"moves\": true only");
  if (!moves) return std::nullopt;
  if (!value.find("mean"))
    value.mistake_at(value.path_of("moves"), "needs \"mean\" and \"covariance\"");
  const auto first = std::find_if(models.begin(), models.end(), [](const BehaviourModel& model) {
    return model.tracked() && model.detectable;
  });
  const bool has_velocity =
      first == models.end() || first->kind == BehaviourModel::Kind::kConstantVelocity;
  for (const char* key : {"velocity", "velocity_covariance"})
    if (!has_velocity && value.find(key))
      value.mistake_at(value.path_of(key),
                       "is nothing that constant_position, the class's first "
                       "tracked model, has");
  Arrival::Motion motion;
  if (const auto velocity = value.find("velocity"))
    motion.velocity = velocity->point(dims).value_or(motion.velocity);
  motion.velocity_covariance = read_covariance(value, "velocity_covariance", dims);
  value.read("at_start", motion.at_start, kNotNegative);
  return motion;
}

Arrival read_arrival(const JsonValue& value, const std::vector<BehaviourModel>& models,
                     const Knowledge& knowledge) {
  Arrival arrival;
  if (!value.object_of({"place", "mean", "covariance", "rate", "moves", "velocity",
                        "velocity_covariance", "at_start"})) {
    return arrival;
  }
  const auto place = value.find("place");
  const auto mean = value.find("mean"), covariance = value.find("covariance");
  if (place && (mean || covariance)) {
    value.mistake("must have either \"place\" or \"mean\" and \"covariance\"");
  } else if (place) {
    arrival.place = place->one_of(names(knowledge.places), "place").value_or(-1);
  } else if (mean && covariance) {
    arrival.mean = mean->point(knowledge.dims).value_or(arrival.mean);
    arrival.covariance =
        read_covariance(value, "covariance", knowledge.dims).value_or(arrival.covariance);
  } else {
    value.mistake("must have \"place\", or \"mean\" and \"covariance\"");
  }
  if (!value.find("rate")) value.mistake_at(value.path_of("rate"), "is missing, arrivals per s");
  value.read("rate", arrival.rate, kRate);
  arrival.motion = read_motion(value, models, knowledge.dims);
  return arrival;
}

/// Whether transitions join tracked models that there are.
bool fit(const std::vector<Transition>& transitions, const std::vector<BehaviourModel>& models) {
  const auto tracked = [&](int m) {
    return m < static_cast<int>(models.size()) && models[static_cast<std::size_t>(m)].tracked();
  };
  return std::all_of(transitions.begin(), transitions.end(),
                     [&](const Transition& t) { return tracked(t.from) && tracked(t.to); });
}

/// A class: what `value` says, and else as `base` is.
ObjectClass read_class(const JsonValue& value, ObjectClass base, const Knowledge& knowledge) {
  if (!value.object_of({"models", "transitions", "changes", "detection_probability", "arrival_rate",
                        "arrivals", "departure_rate", "undetected_intensity", "extent", "phantom",
                        "looks_like"})) {
    return base;
  }
  value.read("phantom", base.phantom);
  if (const auto models = value.find("models")) {
    base.models = read_models(*models, knowledge);
    if (!value.find("transitions") && !fit(base.transitions, base.models)) {
      value.mistake_at(value.path_of("transitions"),
                       "is taken from classes.default and does not fit the models of this class; "
                       "give it transitions of its own, [] for none");
      base.transitions.clear();
    }
  }
  if (const auto transitions = value.find("transitions")) {
    base.transitions = read_transitions(*transitions, base.models);
  }
  if (const auto changes = value.find("changes")) base.changes = read_changes(*changes, knowledge);
  if (const auto detected = value.find("detection_probability")) {
    base.detection_probability =
        read_detection_probability(*detected).value_or(base.detection_probability);
  }
  value.read("arrival_rate", base.arrival_rate, kNotNegative);
  value.read("departure_rate", base.departure_rate, kRate);
  value.read("undetected_intensity", base.undetected_intensity, kNotNegative);
  if (const auto arrivals = value.find("arrivals")) {
    base.arrivals.clear();
    for (const JsonValue& entry : arrivals->elements(kMostArrivals)) {
      base.arrivals.push_back(read_arrival(entry, base.models, knowledge));
    }
  }
  if (const auto extent = value.find("extent")) {
    if (const auto size = extent->numbers(3, kNotNegative)) {
      base.extent = Eigen::Vector3d((*size)[0], (*size)[1], (*size)[2]);
    }
  }
  return base;
}

/// What a phantom looks like: one of the classes, all of which are read.
void read_look(const JsonValue& value, std::vector<ObjectClass>& classes, std::size_t c) {
  const auto look = value.find("looks_like");
  if (!look) return;
  std::vector<std::string> known;
  for (const ObjectClass& other : classes) known.push_back(other.name);
  const auto index = look->one_of(known, "class");
  if (!index) return;
  if (!classes[c].phantom)
    look->mistake("is for a phantom");
  else if (classes[static_cast<std::size_t>(*index)].phantom)
    look->mistake("is a phantom: nothing is reported as one");
  else
    classes[c].looks_like = static_cast<int>(*index);
}

}  // namespace

std::optional<DetectionProbability> read_detection_probability(const JsonValue& value) {
  if (value.json().is_number()) return value.number(kBelowCertain);
  const auto& pair = value.json();
  if (pair.is_array() && pair.size() == 2 && pair[0].is_number() && pair[1].is_number()) {
    const double near = pair[0], per_m = pair[1];
    if (near > 0 && near < 1 && std::abs(per_m) <= kMostPerMetre)
      return DetectionProbability{near, per_m};
  }
  value.mistake(
      "must be a number, or [p, c] with p above 0 and below 1 and c from -1000 to 1000: at r m it "
      "is p' with logit p' = logit p + c r");
  return std::nullopt;
}

void read_classes(const JsonValue& root, Knowledge& knowledge) {
  std::vector<std::string> symbols;
  if (knowledge.class_attribute >= 0) {
    symbols = knowledge.attributes[static_cast<std::size_t>(knowledge.class_attribute)].symbols;
  }
  if (symbols.empty()) symbols = {"object"};
  ObjectClass base = built_in_class();
  const auto section = root.find("classes");
  if (const auto entry = section ? section->find("default") : std::nullopt) {
    base = read_class(*entry, std::move(base), knowledge);
    if (base.phantom) entry->mistake_at(entry->path_of("phantom"), "is for a class by name");
  }
  for (const std::string& symbol : symbols) {
    ObjectClass object_class = base;
    if (const auto entry = section ? section->find(symbol) : std::nullopt) {
      object_class = read_class(*entry, std::move(object_class), knowledge);
    }
    object_class.name = symbol;
    knowledge.classes.push_back(std::move(object_class));
  }
  if (section && std::all_of(knowledge.classes.begin(), knowledge.classes.end(),
                             [](const ObjectClass& c) { return c.phantom; }))
    section->mistake("must have a class that is no phantom");
  if (!section) return;
  if (const auto entry = section->find("default"); entry && entry->find("looks_like"))
    entry->find("looks_like")->mistake("is for a class by name");
  for (std::size_t c = 0; c < symbols.size(); ++c)
    if (const auto entry = section->find(symbols[c])) read_look(*entry, knowledge.classes, c);
  std::vector<std::string> known = symbols;
  known.push_back("default");
  const std::set<std::string> lookup(known.begin(), known.end());
  for (const auto& [name, entry] : section->members()) {
    if (lookup.count(name)) continue;
    entry.mistake(knowledge.class_attribute >= 0
                      ? "no symbol of the attribute \"class\"; " + suggestion(name, known)
                      : "without an attribute \"class\" there is only \"object\"; name the classes "
                        "in attributes.class.symbols");
  }
}

}  // namespace anchord
