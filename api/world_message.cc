#include "api/world_message.h"

#include <algorithm>
#include <anchord/world_t.hpp>

#include "lcmtypes/codec.h"

namespace anchord {
namespace {

attribute_t attribute_message(const AttributeBelief& belief, const Attribute& attribute) {
  attribute_t out{};
  out.name = attribute.name;
  out.kind = belief.symbols.empty() ? attribute_t::SCALAR : attribute_t::SYMBOLS;
  out.num_symbols = static_cast<std::int32_t>(belief.symbols.size());
  if (!belief.symbols.empty()) out.symbols = attribute.symbols;
  out.probabilities.assign(belief.symbols.begin(), belief.symbols.end());
  out.mean = belief.mean;
  out.variance = belief.variance;
  return out;
}

object_t object_message(const ObjectBelief& object, const Background& background) {
  const Leaf& leaf = object.versions[object.best].leaf;
  const Kinematic& where = position_of(leaf);
  const Eigen::Vector3d velocity = velocity_of(leaf, background);
  object_t out{};
  out.id = object.anchor->id();
  out.p = object.p;
  if (background.knowledge.class_attribute >= 0)
    out.symbol_class = background.object_class(leaf.top_class()).name;
  out.class_p = leaf.classes[leaf.top_class()];
  for (int i = 0; i < 3; ++i) {
    out.position[i] = where.position[i];
    out.velocity[i] = velocity[i];
    out.extent[i] = background.object_class(leaf.top_class()).extent[i];
    for (int j = 0; j < 3; ++j) out.covariance[3 * i + j] = where.pp(i, j);
  }
  out.has_yaw = leaf.yaw.has_value();
  out.yaw = leaf.yaw.value_or(0);
  const int place = object.place(background);
  if (place >= 0) out.place = background.knowledge.places[place].name;
  out.last_seen = leaf.last_seen;
  for (const AttributeBelief& belief : leaf.attributes)
    out.attributes.push_back(
        attribute_message(belief, background.knowledge.attributes[belief.attribute]));
  out.num_attributes = static_cast<std::int32_t>(out.attributes.size());
  return out;
}

}  // namespace

std::vector<std::uint8_t> encode_world(const Belief& belief, const Background& background,
                                       std::int64_t seq) {
  world_t out{};
  out.utime = belief.utime;
  out.seq = seq;
  out.num_clusters = static_cast<std::int32_t>(belief.clusters.size());
  for (const auto& cluster : belief.clusters)
    out.num_hypotheses += static_cast<std::int32_t>(cluster->hypotheses.size());
  for (const auto& object : read_objects(belief, belief.utime, 0, background)) {
    out.expected_count += object.p;
    if (object.in_best) out.objects.push_back(object_message(object, background));
  }
  out.num_objects = static_cast<std::int32_t>(out.objects.size());
  return encode_message(out);
}

}  // namespace anchord
