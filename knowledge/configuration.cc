#include "knowledge/configuration.h"

#include <cstdint>
#include <exception>
#include <nlohmann/json.hpp>

#include "knowledge/configuration_file.h"
#include "knowledge/configuration_reader.h"

namespace anchord {
namespace {

/// FNV-1a, 64 bits (Fowler, Noll, Vo).
std::uint64_t fingerprint_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

/// What of a configuration touches the belief.
nlohmann::json of_the_belief(nlohmann::json document) {
  document.erase("maintenance");
  document.erase("log");
  if (const auto sensors = document.find("sensors");
      sensors != document.end() && sensors->is_object())
    for (nlohmann::json& sensor : *sensors)
      if (sensor.is_object()) sensor.erase("verification");
  return document;
}

template <typename... Source>
Configuration configuration_of(const Source&... source) {
  ConfigurationMistakes mistakes;
  try {
    if (const auto document = load_document(source..., mistakes)) {
      Knowledge knowledge = read_knowledge(*document, mistakes);
      knowledge.text = document->dump();
      knowledge.whole_fingerprint = fingerprint_of(knowledge.text);
      knowledge.fingerprint = fingerprint_of(of_the_belief(*document).dump());
      if (mistakes.empty()) return knowledge;
    }
  } catch (const std::exception& error) {  // out of memory, a path that the system cannot have
    mistakes.push_back({"", std::string("cannot be read: ") + error.what()});
  }
  return mistakes;
}

}  // namespace

Configuration read_configuration(const std::filesystem::path& file) {
  return configuration_of(file);
}

Configuration parse_configuration(std::string_view text, const std::filesystem::path& directory) {
  return configuration_of(text, directory);
}

}  // namespace anchord
