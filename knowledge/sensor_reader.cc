#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/view.h"
#include "knowledge/attribute_members.h"
#include "knowledge/configuration_reader.h"

namespace anchord {
namespace {

constexpr std::size_t kMostSensors = 100;
constexpr Range kShare{0, 1, true, true};
constexpr double kLeastPrior = 1e-6;     // as the floor of reported probabilities
constexpr double kMostProbable = 1.001;  // a sum of printed probabilities may be rounded

/// A sensor whose detection probabilities are not yet filled up from the classes.
struct Draft {
  Sensor sensor;
  std::vector<std::optional<DetectionProbability>> detection_probability;  // per class
};

std::vector<std::string> names(const std::vector<ObjectClass>& classes) {
  std::vector<std::string> all;
  for (const ObjectClass& object_class : classes) all.push_back(object_class.name);
  return all;
}

/// Calls read(class, entry) for what an object says of classes by name; what it names "default", or
/// what is no object, goes to rest(entry) before.
template <typename Rest, typename Read>
void read_by_class(const JsonValue& value, const Knowledge& knowledge, Rest rest, Read read) {
  if (!value.json().is_object()) return rest(value);
  if (const auto entry = value.find("default")) rest(*entry);
  const std::vector<std::string> known = names(knowledge.classes);
  for (const auto& [name, entry] : value.members()) {
    if (name == "default") continue;
    if (const auto index = entry.index_of(name, known, "class"))
      read(static_cast<std::size_t>(*index), entry);
  }
}

/// A number, or an object of numbers.
bool number_by_class(const JsonValue& value) {
  const bool is = value.json().is_number() || value.json().is_object();
  if (!is) value.mistake("must be a number, or an object with a number for each class");
  return is;
}

void read_detection_probabilities(const JsonValue& value, const Knowledge& knowledge,
                                  Draft& draft) {
  auto& all = draft.detection_probability;
  read_by_class(
      value, knowledge,
      [&](const JsonValue& rest) {
        if (const auto p = read_detection_probability(rest)) all.assign(all.size(), *p);
      },
      [&](std::size_t c, const JsonValue& entry) {
        if (const auto p = read_detection_probability(entry)) all[c] = p;
      });
}

/// Whether something may be reported as this class.
bool is_label(std::size_t c, const JsonValue& entry, const Knowledge& knowledge) {
  if (knowledge.classes[c].phantom) entry.mistake("is a phantom: nothing is reported as one");
  return !knowledge.classes[c].phantom;
}

/// By what clutter looks like: of classes that are not named there is none.
void read_clutter_density(const JsonValue& value, const Knowledge& knowledge, Sensor& sensor) {
  if (!number_by_class(value)) return;
  sensor.clutter_looks.clear();
  if (!value.json().is_object()) {
    sensor.clutter_density = value.number(kPositive).value_or(sensor.clutter_density);
    return;
  }
  std::vector<double> densities(knowledge.classes.size(), 0);
  read_by_class(
      value, knowledge, [](const JsonValue& rest) { rest.mistake("is no class"); },
      [&](std::size_t c, const JsonValue& entry) {
        if (is_label(c, entry, knowledge)) densities[c] = entry.number(kPositive).value_or(0);
      });
  const double sum = std::accumulate(densities.begin(), densities.end(), 0.0);
  if (value.members().empty()) value.mistake("must name a class that clutter looks like");
  if (!(sum > 0)) return;
  sensor.clutter_density = sum;
  sensor.clutter_looks = std::move(densities);
  for (double& share : sensor.clutter_looks) share /= sum;
}

/// A setting by label: what parse(entry) makes of one entry, where it can.
template <typename T, typename Parse>
void read_by_label(const JsonValue& value, const Knowledge& knowledge, ByLabel<T>& to,
                   Parse parse) {
  read_by_class(
      value, knowledge,
      [&](const JsonValue& rest) {
        if (const auto all = parse(rest)) to = {*all, {}};
      },
      [&](std::size_t c, const JsonValue& entry) {
        if (to.of.empty()) to.of.assign(knowledge.classes.size(), to.rest);
        if (!is_label(c, entry, knowledge)) return;
        if (const auto one = parse(entry)) to.of[c] = *one;
      });
}

void read_noise(const JsonValue& value, int dims, Sensor& sensor) {
  if (value.json().is_array()) {
    sensor.noise = value.covariance(dims).value_or(sensor.noise);
    return;
  }
  if (!value.json().is_object()) {
    value.mistake("must be a position covariance (an array of " + std::to_string(dims * dims) +
                  R"( numbers), or an object with "covariance", "polar" or both)");
    return;
  }
  value.object_of({"covariance", "polar"});
  if (const auto covariance = value.find("covariance")) {
    sensor.noise = covariance->covariance(dims).value_or(sensor.noise);
  }
  if (const auto polar = value.find("polar")) {
    sensor.polar_noise = polar->numbers(3, kPositive).value_or(sensor.polar_noise);
  }
}

/// for_each_attribute() of the categorical ones; a scalar one is a mistake.
template <typename Read>
void for_each_categorical(const JsonValue& value, const Knowledge& knowledge, Read read) {
  for_each_attribute(value, knowledge,
                     [&](std::size_t a, const Attribute& attribute, const JsonValue& entry) {
                       if (attribute.kind == Attribute::Kind::kScalar)
                         entry.mistake("is a scalar attribute; only categorical ones have this");
                       else
                         read(a, attribute, entry);
                     });
}

void read_prior(const JsonValue& value, const Knowledge& knowledge, Sensor& sensor) {
  for_each_categorical(value, knowledge,
                       [&](std::size_t a, const Attribute& attribute, const JsonValue& entry) {
                         auto prior = read_distribution(entry, attribute.symbols);
                         if (!prior) return;
                         double sum = 0;
                         for (double& p : *prior) sum += p = std::max(p, kLeastPrior);
                         for (double& p : *prior) p /= sum;
                         sensor.prior[a] = std::move(*prior);
                       });
}

void read_confusion(const JsonValue& value, const Knowledge& knowledge, Sensor& sensor) {
  for_each_categorical(value, knowledge,
                       [&](std::size_t a, const Attribute& attribute, const JsonValue& entry) {
                         const std::size_t n = attribute.symbols.size();
                         std::vector<std::vector<double>> rows(n, std::vector<double>(n, 0.0));
                         for (std::size_t s = 0; s < n; ++s) rows[s][s] = 1;
                         for (const auto& [name, row] : entry.members()) {
                           const auto s = row.index_of(name, attribute.symbols, "symbol");
                           if (!s) continue;
                           if (auto reported = read_distribution(row, attribute.symbols)) {
                             rows[static_cast<std::size_t>(*s)] = std::move(*reported);
                           }
                         }
                         sensor.confusion[a] = std::move(rows);
                       });
}

std::optional<ScoreCalibration> read_score_calibration(const JsonValue& value) {
  const auto numbers = value.numbers(value.json().size() == 3 ? 3 : 2);
  if (!numbers) return std::nullopt;
  if ((*numbers)[1] > 0)
    return ScoreCalibration{(*numbers)[0], (*numbers)[1], numbers->size() == 3 ? (*numbers)[2] : 0};
  value.mistake("must be [a, b] or [a, b, c] with b above 0: logit p' = a + b logit p + c range");
  return std::nullopt;
}

std::optional<ScoreMemory> read_one_score_memory(const JsonValue& value) {
  if (!value.object_of({"share", "seconds"})) return std::nullopt;
  ScoreMemory memory;
  value.read("share", memory.share, kBelowCertain);
  value.read("seconds", memory.seconds, kPositive);
  return memory;
}

/// One, or one for each class: that has an object for each name.
void read_score_memory(const JsonValue& value, const Knowledge& knowledge, Sensor& sensor) {
  const auto members = value.members();
  const bool by_label =
      !members.empty() && std::all_of(members.begin(), members.end(), [](const auto& member) {
        return member.second.json().is_object();
      });
  if (by_label)
    read_by_label(value, knowledge, sensor.score_memory, read_one_score_memory);
  else if (const auto one = read_one_score_memory(value))
    sensor.score_memory = {*one, {}};
}

/// A sensor: what `value` says, and else as `draft` is.
Draft read_sensor(const JsonValue& value, Draft draft, const Knowledge& knowledge) {
  if (!value.object_of({"clutter_density", "detection_probability", "view", "noise", "prior",
                        "confusion", "score_calibration", "real_share", "score_memory",
                        "pose_floor", "identity_doubt", "double_detection", "verification"})) {
    return draft;
  }
  Sensor& sensor = draft.sensor;
  if (const auto density = value.find("clutter_density")) {
    read_clutter_density(*density, knowledge, sensor);
  }
  value.read("pose_floor", sensor.pose_floor, kNotNegative);
  if (const auto share = value.find("real_share"); share && number_by_class(*share)) {
    read_by_label(*share, knowledge, sensor.real_share,
                  [](const JsonValue& entry) { return entry.number(kShare); });
  }
  if (const auto memory = value.find("score_memory")) read_score_memory(*memory, knowledge, sensor);
  if (const auto calibration = value.find("score_calibration")) {
    read_by_label(*calibration, knowledge, sensor.score_calibration, read_score_calibration);
  }
  value.read("identity_doubt", sensor.identity_doubt, kAboveImpossible);
  value.read("double_detection", sensor.double_detection, kProbability);
  if (const auto p = value.find("detection_probability")) {
    read_detection_probabilities(*p, knowledge, draft);
  }
  if (const auto view = value.find("view")) sensor.view = read_view(*view, knowledge.dims);
  if (const auto noise = value.find("noise")) read_noise(*noise, knowledge.dims, sensor);
  if (const auto prior = value.find("prior")) read_prior(*prior, knowledge, sensor);
  if (const auto confusion = value.find("confusion")) {
    read_confusion(*confusion, knowledge, sensor);
  }
  if (const auto verification = value.find("verification")) {
    if (!sensor.verification) {
      sensor.verification.emplace();
      sensor.verification->noise.resize(knowledge.classes.size());
    }
    read_verification(*verification, knowledge, *sensor.verification);
  }
  return draft;
}

Sensor finished(Draft draft, std::string name, const Knowledge& knowledge) {
  draft.sensor.name = std::move(name);
  for (std::size_t c = 0; c < knowledge.classes.size(); ++c) {
    draft.sensor.detection_probability.push_back(
        draft.detection_probability[c].value_or(knowledge.classes[c].detection_probability));
  }
  return std::move(draft.sensor);
}

}  // namespace

std::optional<std::vector<double>> read_distribution(const JsonValue& value,
                                                     const std::vector<std::string>& symbols) {
  std::vector<std::optional<double>> named(symbols.size());
  double sum = 0;
  std::size_t count = 0;
  bool right = value.json().is_object();
  for (const auto& [name, entry] : value.members()) {
    const auto index = entry.index_of(name, symbols, "symbol");
    const auto p = index ? entry.number(kProbability) : std::nullopt;
    right = right && p;
    if (!p) continue;
    named[static_cast<std::size_t>(*index)] = p;
    sum += *p;
    ++count;
  }
  if (!right) return std::nullopt;
  const bool complete = count == symbols.size();
  if (sum > kMostProbable || (complete && sum <= 0)) {
    value.mistake("must sum to at most 1, and not to 0 where every symbol is named");
    return std::nullopt;
  }
  const double rest =
      complete ? 0 : std::max(0.0, 1 - sum) / static_cast<double>(symbols.size() - count);
  std::vector<double> distribution;
  for (const auto& p : named) distribution.push_back(p.value_or(rest));
  const double total = sum + rest * static_cast<double>(symbols.size() - count);
  for (double& p : distribution) p /= total;
  return distribution;
}

void read_sensors(const JsonValue& root, Knowledge& knowledge) {
  Draft base;
  base.detection_probability.resize(knowledge.classes.size());
  base.sensor.prior.resize(knowledge.attributes.size());
  base.sensor.confusion.resize(knowledge.attributes.size());
  for (std::size_t a = 0; a < knowledge.attributes.size(); ++a) {
    const std::size_t n = knowledge.attributes[a].symbols.size();
    base.sensor.prior[a].assign(n, 1 / static_cast<double>(n));
  }
  const auto section = root.find("sensors");
  if (const auto entry = section ? section->find("default") : std::nullopt) {
    base = read_sensor(*entry, std::move(base), knowledge);
  }
  knowledge.default_sensor = finished(base, "default", knowledge);
  knowledge.default_sensor.verification.reset();  // a task names its sensor
  if (!section) return;
  if (section->json().size() > kMostSensors + 1) section->mistake("has over 100 sensors");
  for (const auto& [name, entry] : section->members()) {
    if (name == "default" || !check_name(entry, name)) continue;
    Sensor sensor = finished(read_sensor(entry, base, knowledge), name, knowledge);
    finish_verification(entry, sensor);
    knowledge.sensors.push_back(std::move(sensor));
  }
}

}  // namespace anchord
