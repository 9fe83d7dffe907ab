#include "anchoring/in_use.h"

#include <algorithm>

namespace anchord {
namespace {

Error conflict(std::string field, std::string message) {
  return {ErrorCode::kConflict, std::move(field), std::move(message)};
}

}  // namespace

InUse::InUse(const Correspondence& correspondence, Utime utime)
    : of_(correspondence),
      utime_(utime),
      classes_(of_.from.knowledge.classes.size()),
      attributes_(of_.from.knowledge.attributes.size()) {
  for (const Attribute& attribute : of_.from.knowledge.attributes)
    symbols_.emplace_back(attribute.symbols.size());
}

void InUse::add(const Cluster& cluster) {
  for (const AnchorTree& tree : cluster.anchors)
    for (const auto& leaf : tree.leaves) add(*tree.anchor, of_.up_to(*leaf, utime_));
}

void InUse::add(const Anchor& anchor, const Leaf& leaf) {
  const auto use = [&](Users& users) { users.ids.try_emplace(anchor.birth, anchor.id()); };
  use(all_);
  use(classes_[leaf.top_class()]);
  for (const AttributeBelief& belief : leaf.attributes) {
    use(attributes_[belief.attribute]);
    if (belief.symbols.empty()) continue;
    const auto top = std::max_element(belief.symbols.begin(), belief.symbols.end());
    use(symbols_[belief.attribute][top - belief.symbols.begin()]);
  }
}

std::string InUse::Users::text() const {
  std::string text = ids.begin()->second;
  if (ids.size() == 2) text += " and " + std::next(ids.begin())->second;
  if (ids.size() > 2) text += " and " + std::to_string(ids.size() - 1) + " others";
  return text;
}

Status InUse::check() const {
  const Knowledge &old = of_.from.knowledge, &now = of_.to.knowledge;
  if (now.dims != old.dims && all_.any())
    return conflict("world.dimensions", "cannot change while there are objects: " + all_.text());
  for (std::size_t a = 0; a < attributes_.size(); ++a) {
    const std::string path = "attributes." + old.attributes[a].name;
    if (of_.attributes[a] < 0 && attributes_[a].any())
      return conflict(
          path, (now.find_attribute(old.attributes[a].name) < 0 ? "cannot be taken away: "
                                                                : "cannot be of another kind: ") +
                    std::string("it is known of ") + attributes_[a].text());
    for (std::size_t s = 0; s < symbols_[a].size(); ++s)
      if (of_.symbols[a][s] < 0 && symbols_[a][s].any())
        return conflict(path + ".symbols", "'" + old.attributes[a].symbols[s] +
                                               "' cannot be taken away: it is the most probable "
                                               "one of " +
                                               symbols_[a][s].text());
  }
  for (std::size_t c = 0; c < classes_.size(); ++c)
    if (of_.classes[c] < 0 && classes_[c].any())
      return conflict("classes." + old.classes[c].name,
                      "cannot be taken away: it is the most probable one of " + classes_[c].text());
  return Done{};
}

}  // namespace anchord
