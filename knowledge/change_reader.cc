#include <algorithm>
#include <set>

#include "knowledge/attribute_members.h"
#include "knowledge/configuration_reader.h"

namespace anchord {
namespace {

constexpr std::size_t kMostTransitions = kMostChanging * kMostChanging;

std::optional<int> read_symbol(const JsonValue& transition, const char* key,
                               const std::vector<std::string>& symbols) {
  if (const auto symbol = transition.find(key)) return symbol->one_of(symbols, "symbol");
  transition.mistake_at(transition.path_of(key), "is missing; it must be a symbol");
  return std::nullopt;
}

std::vector<Transition> read_transitions(const JsonValue& value,
                                         const std::vector<std::string>& symbols) {
  std::vector<Transition> transitions;
  std::set<std::pair<int, int>> seen;
  std::set<int> joined;
  for (const JsonValue& entry : value.elements(kMostTransitions)) {
    if (!entry.object_of({"from", "to", "rate"})) continue;
    const auto from = read_symbol(entry, "from", symbols), to = read_symbol(entry, "to", symbols);
    Transition transition;
    if (!entry.find("rate")) entry.mistake_at(entry.path_of("rate"), "is missing, 1/s");
    entry.read("rate", transition.rate, kRate);
    if (!from || !to) continue;
    if (*from == *to) entry.mistake("must lead to another symbol");
    if (!seen.insert({*from, *to}).second)
      entry.mistake("stands there already: give one rate from one symbol to another");
    joined.insert({*from, *to});
    transition.from = *from;
    transition.to = *to;
    transitions.push_back(transition);
  }
  if (joined.size() > kMostChanging)
    value.mistake("join over " + std::to_string(kMostChanging) + " symbols");
  return transitions;
}

}  // namespace

std::vector<AttributeChange> read_changes(const JsonValue& value, const Knowledge& knowledge) {
  std::vector<AttributeChange> changes;
  for_each_attribute(
      value, knowledge, [&](std::size_t a, const Attribute& attribute, const JsonValue& entry) {
        AttributeChange change;
        change.attribute = static_cast<int>(a);
        if (change.attribute == knowledge.class_attribute) {
          entry.mistake("an object keeps its class; what changes is another attribute");
        } else if (attribute.kind == Attribute::Kind::kScalar) {
          if (!entry.object_of({"drift"})) return;
          entry.read("drift", change.drift, kNotNegative);
        } else {
          if (!entry.object_of({"redraw", "transitions"})) return;
          entry.read("redraw", change.redraw, kRate);
          const auto transitions = entry.find("transitions");
          if (transitions) change.transitions = read_transitions(*transitions, attribute.symbols);
          if (transitions && entry.find("redraw"))
            entry.mistake("must have either \"redraw\" or \"transitions\"");
        }
        changes.push_back(std::move(change));
      });
  return changes;
}

}  // namespace anchord
