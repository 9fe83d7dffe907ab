#pragma once

#include <string>
#include <vector>

#include "knowledge/json_reader.h"
#include "knowledge/knowledge.h"

namespace anchord {

/// Calls `read(attribute index, attribute, value)` for every member that names an attribute; notes
/// one that does not.
template <typename Read>
void for_each_attribute(const JsonValue& value, const Knowledge& knowledge, Read read) {
  std::vector<std::string> known;
  for (const Attribute& attribute : knowledge.attributes) known.push_back(attribute.name);
  for (const auto& [name, entry] : value.members())
    if (const auto index = entry.index_of(name, known, "attribute"))
      read(static_cast<std::size_t>(*index), knowledge.attributes[static_cast<std::size_t>(*index)],
           entry);
}

}  // namespace anchord
