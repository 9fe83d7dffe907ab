#include "knowledge/configuration.h"

#include <exception>

#include "knowledge/configuration_file.h"
#include "knowledge/configuration_reader.h"

namespace anchord {
namespace {

template <typename... Source>
Configuration configuration_of(const Source&... source) {
  ConfigurationMistakes mistakes;
  try {
    if (const auto document = load_document(source..., mistakes)) {
      Knowledge knowledge = read_knowledge(*document, mistakes);
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
