#include "api/parameters.h"

#include <charconv>
#include <set>
#include <sstream>

namespace anchord {
namespace {

template <typename Number>
std::optional<Number> number_in(const std::string& text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (const auto& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

Result<Description::Term> read_term(const std::string& name, const std::string& value,
                                    const Knowledge& knowledge) {
  const int a = knowledge.find_attribute(name);
  const Attribute& attribute = knowledge.attributes[a];
  const int symbol = attribute.find(value);
  if (symbol >= 0) return Description::Term{a, symbol};
  std::vector<std::string> known = attribute.symbols;
  for (const Predicate& predicate : attribute.predicates) known.push_back(predicate.name);
  return invalid(name, "\"" + value + "\" is unknown; there are: " + listed(known));
}

Result<double> read_probability(const std::string& name, const std::string& value) {
  const auto p = number_in<double>(value);
  if (p && *p >= 0 && *p <= 1) return *p;
  return invalid(name, "must be a probability, 0 to 1");
}

Result<int> read_limit(const std::string& value) {
  const auto n = number_in<int>(value);
  if (n && *n >= 1 && *n <= 1000) return *n;
  return invalid("limit", "must be a whole number, 1 to 1000");
}

}  // namespace

Result<Parameters> read_parameters(const HttpTarget& target, const std::string& allowed,
                                   const Background& background) {
  std::istringstream words(allowed);
  std::set<std::string> known;
  for (std::string word; words >> word;) known.insert(word);
  const bool describes = known.erase("description") > 0;

  const Knowledge& knowledge = background.knowledge;
  Parameters out;
  std::set<std::string> seen;
  for (const auto& [name, value] : target.parameters) {
    if (!seen.insert(name).second) return invalid(name, "is given twice");
    if (known.count(name)) {
      if (name == "place") {
        out.place = knowledge.find_place(value);
        if (out.place < 0) return invalid(name, "there is no place \"" + value + "\"");
      } else if (name == "min_p") {
        auto p = read_probability(name, value);
        if (!p) return p.error();
        out.min_p = *p;
      } else if (name == "limit") {
        auto limit = read_limit(value);
        if (!limit) return limit.error();
        out.limit = *limit;
      } else {
        out.object = value;
      }
    } else if (describes && knowledge.find_attribute(name) >= 0) {
      auto term = read_term(name, value, knowledge);
      if (!term) return term.error();
      out.description.terms.push_back(*term);
    } else {
      std::vector<std::string> names(known.begin(), known.end());
      if (describes)
        for (const Attribute& attribute : knowledge.attributes) names.push_back(attribute.name);
      return invalid(name, "is no parameter here; there are: " + listed(names));
    }
  }
  return out;
}

}  // namespace anchord
