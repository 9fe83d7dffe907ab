#include <algorithm>
#include <limits>
#include <set>

#include "knowledge/configuration_reader.h"

namespace anchord {
namespace {

constexpr std::size_t kMostSymbols = 1000;
constexpr std::size_t kMostAttributes = 100;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void read_symbols(const JsonValue& value, Attribute& attribute) {
  const auto symbols = value.find("symbols");
  if (!symbols) {
    value.mistake_at(value.path_of("symbols"),
                     R"(is missing; it must be an array of names, such as ["red", "blue"])");
    return;
  }
  std::set<std::string> seen;
  for (const JsonValue& entry : symbols->elements(kMostSymbols)) {
    const auto symbol = entry.name();
    if (!symbol) continue;
    if (seen.insert(*symbol).second) {
      attribute.symbols.push_back(*symbol);
    } else {
      entry.mistake("\"" + *symbol + "\" is there already");
    }
  }
  if (symbols->json().is_array() && symbols->json().empty()) {
    symbols->mistake("must name at least one symbol");
  }
  if (attribute.name != "class") return;
  for (const char* reserved : {"default", "new"}) {
    if (seen.count(reserved)) {
      symbols->mistake(std::string("no class can be called \"") + reserved +
                       (*reserved == 'd' ? "\": it is the template of all classes"
                                         : "\": objects without a name yet are new-1, new-2, ..."));
    }
  }
}

/// [min, max] with null for no bound.
void read_predicate(const std::string& name, const JsonValue& value, Attribute& attribute) {
  constexpr const char* kShape = "must be [least, most] with least below most; null is no bound";
  if (!check_name(value, name)) return;
  const std::vector<JsonValue> bounds = value.elements(2);
  if (bounds.size() != 2) {
    if (value.json().is_array() && value.json().size() < 2) value.mistake(kShape);
    return;
  }
  double both[2] = {-kInfinity, kInfinity};
  for (std::size_t i = 0; i < 2; ++i) {
    if (bounds[i].json().is_null()) continue;
    const auto bound = bounds[i].number();
    if (!bound) return;
    both[i] = *bound;
  }
  if (!(both[0] < both[1])) {
    value.mistake(kShape);
    return;
  }
  attribute.predicates.push_back({name, both[0], both[1]});
}

void read_scalar(const JsonValue& value, Attribute& attribute) {
  value.read("unit", attribute.unit);
  if (const auto predicates = value.find("predicates")) {
    if (predicates->json().size() > kMostSymbols) predicates->mistake("has over 1000 predicates");
    for (const auto& [name, bounds] : predicates->members()) {
      read_predicate(name, bounds, attribute);
    }
  }
  std::stable_sort(attribute.predicates.begin(), attribute.predicates.end(),
                   [](const Predicate& a, const Predicate& b) {
                     return a.min != b.min ? a.min < b.min : a.max < b.max;
                   });
  double least = kInfinity, most = -kInfinity;
  for (const Predicate& predicate : attribute.predicates) {
    for (const double bound : {predicate.min, predicate.max}) {
      if (bound == kInfinity || bound == -kInfinity) continue;
      least = std::min(least, bound);
      most = std::max(most, bound);
    }
  }
  if (least < most) attribute.reference_density = 1 / (most - least);
  value.read("reference_density", attribute.reference_density, kPositive);
}

}  // namespace

void read_attributes(const JsonValue& root, Knowledge& knowledge) {
  const auto section = root.find("attributes");
  if (!section) return;
  if (section->json().size() > kMostAttributes) section->mistake("has over 100 attributes");
  for (const auto& [name, value] : section->members()) {
    Attribute attribute;
    attribute.name = name;
    if (!check_name(value, name) || !value.object()) continue;
    const auto kind = value.find("kind");
    if (!kind) {
      value.mistake_at(value.path_of("kind"),
                       R"(is missing; it must be "categorical" or "scalar")");
      continue;
    }
    const auto index = kind->one_of({"categorical", "scalar"}, "kind of attribute");
    if (!index) continue;
    attribute.kind = *index == 0 ? Attribute::Kind::kCategorical : Attribute::Kind::kScalar;
    if (attribute.kind == Attribute::Kind::kCategorical) {
      value.object_of({"kind", "symbols"});
      read_symbols(value, attribute);
    } else {
      value.object_of({"kind", "unit", "predicates", "reference_density"});
      read_scalar(value, attribute);
      if (name == "class") kind->mistake("the attribute \"class\" must be categorical");
    }
    if (name == "class") knowledge.class_attribute = static_cast<int>(knowledge.attributes.size());
    knowledge.attributes.push_back(std::move(attribute));
  }
}

}  // namespace anchord
