#include "anchoring/correspondence.h"

#include <algorithm>

namespace anchord {
namespace {

bool same_dynamics(const ObjectClass& a, const ObjectClass& b) {
  return a.name == b.name && a.models == b.models && a.transitions == b.transitions &&
         a.changes == b.changes && a.departure_rate == b.departure_rate;
}

bool same_values(const Attribute& a, const Attribute& b) {
  return a.name == b.name && a.kind == b.kind && a.symbols == b.symbols;
}

bool same_place(const Place& a, const Place& b) { return a.name == b.name && a.region == b.region; }

template <typename T, typename Same>
bool all_the_same(const std::vector<T>& a, const std::vector<T>& b, Same same) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

}  // namespace

Correspondence::Correspondence(const Background& before, const Background& after)
    : from(before), to(after), places_{-1} {
  const Knowledge &old = from.knowledge, &now = to.knowledge;
  for (const ObjectClass& c : old.classes) classes.push_back(now.find_class(c.name));
  for (const Attribute& attribute : old.attributes) {
    int index = now.find_attribute(attribute.name);
    if (index >= 0 && now.attributes[index].kind != attribute.kind) index = -1;
    attributes.push_back(index);
    auto& found = symbols.emplace_back();
    for (const std::string& symbol : attribute.symbols)
      found.push_back(index < 0 ? -1 : now.attributes[index].find(symbol));
  }
  for (const Place& place : old.places) {
    const int index = now.find_place(place.name);
    places_.push_back(index < 0 ? FormerModels::kNoPlace : index);
  }
  for (const ObjectClass& c : old.classes) {
    auto& models = models_.emplace_back(c.models);
    for (BehaviourModel& model : models) {
      model.place = place(model.place);
      if (model.growing >= 0) model.growing = attributes[model.growing];
    }
  }
  same_dynamics = from.grid == to.grid && from.dims == to.dims &&
                  all_the_same(old.classes, now.classes, anchord::same_dynamics) &&
                  all_the_same(old.attributes, now.attributes, same_values) &&
                  all_the_same(old.places, now.places, same_place);
}

Leaf Correspondence::up_to(Leaf leaf, Utime utime) const {
  if (!same_dynamics && leaf.utime < utime) predict(leaf, utime, from);
  return leaf;
}

int Correspondence::former_class(int c) const {
  const auto at = std::find(classes.begin(), classes.end(), c);
  return at == classes.end() ? -1 : static_cast<int>(at - classes.begin());
}

}  // namespace anchord
