#include "tools/anchorctl/query.h"

#include <algorithm>

#include "core/percent_encoding.h"

namespace anchord {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// "cup-12": what the daemon calls anchors.
bool is_object_id(const std::string& word) {
  const std::size_t dash = word.rfind('-');
  return dash != std::string::npos && dash > 0 && dash + 1 < word.size() &&
         std::all_of(word.begin() + static_cast<std::ptrdiff_t>(dash) + 1, word.end(), is_digit);
}

bool is_option(const std::string& word) { return word.size() > 1 && word[0] == '-'; }

}  // namespace

Result<Parameters> parse_words(const std::vector<std::string>& words) {
  Parameters parameters;
  std::string bare;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    const std::size_t equals = word.find('=');
    std::string name, value;
    if (is_option(word)) {
      if (word[1] != '-' || word.size() == 2) return invalid(word, "no such option");
      name = word.substr(2, equals == std::string::npos ? equals : equals - 2);
      std::replace(name.begin(), name.end(), '-', '_');
      if (equals != std::string::npos) {
        value = word.substr(equals + 1);
      } else if (i + 1 < words.size() && words[i + 1].rfind("--", 0) != 0) {
        value = words[++i];
      } else {
        return invalid(word, "needs a value");
      }
    } else if (equals != std::string::npos) {
      name = word.substr(0, equals);
      value = word.substr(equals + 1);
    } else {
      if (!bare.empty()) {
        return invalid(word, "one class or object has been named already (" + bare +
                                 "); what else it is like is said as key=value, as in color=blue");
      }
      bare = word;
      name = is_object_id(word) ? "object" : "class";
      value = word;
    }
    if (name.empty()) return invalid(word, "has no name before the '='");
    if (find_parameter(parameters, name)) return invalid(name, "is given twice");
    parameters.emplace_back(std::move(name), std::move(value));
  }
  return parameters;
}

const std::string* find_parameter(const Parameters& parameters, const std::string& name) {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const auto& parameter) { return parameter.first == name; });
  return found == parameters.end() ? nullptr : &found->second;
}

std::string make_target(const std::string& command, Parameters parameters) {
  std::string target = "/v1/" + command;
  const std::string* object = find_parameter(parameters, "object");
  if (command == "objects" && object) {
    target += "/" + percent_encoded(*object);
    std::erase_if(parameters, [](const auto& parameter) { return parameter.first == "object"; });
  }
  return target + (parameters.empty() ? "" : "?" + make_query(parameters));
}

std::string make_query(const Parameters& parameters) {
  std::string query;
  for (const auto& [name, value] : parameters)
    query += (query.empty() ? "" : "&") + percent_encoded(name) + "=" + percent_encoded(value);
  return query;
}

}  // namespace anchord
