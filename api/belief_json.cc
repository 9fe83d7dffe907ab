#include "api/belief_json.h"

#include <span>

namespace anchord {
namespace {

Json symbols_json(std::span<const double> p, const Attribute& attribute) {
  Json out = Json::object();
  for (std::size_t s = 0; s < p.size(); ++s) out[attribute.symbols[s]] = p[s];
  return out;
}

Json class_json(const std::vector<double>& p, const Background& background) {
  return symbols_json(p, background.knowledge.attributes[background.knowledge.class_attribute]);
}

}  // namespace

Json position_json(const Eigen::Vector3d& position, int dims) {
  Json out = Json::array();
  for (int i = 0; i < dims; ++i) out.push_back(position[i]);
  return out;
}

Json covariance_json(const Eigen::Matrix3d& covariance, int dims) {
  Json out = Json::array();
  for (int i = 0; i < dims; ++i)
    for (int j = 0; j < dims; ++j) out.push_back(covariance(i, j));
  return out;
}

Json attributes_json(const Leaf& leaf, const Background& background) {
  Json out = Json::object();
  if (background.knowledge.class_attribute >= 0)
    out["class"] = class_json({leaf.classes.begin(), leaf.classes.end()}, background);
  for (const AttributeBelief& belief : leaf.attributes) {
    const Attribute& attribute = background.knowledge.attributes[belief.attribute];
    if (attribute.kind == Attribute::Kind::kCategorical)
      out[attribute.name] = symbols_json(belief.symbols, attribute);
    else
      out[attribute.name] = {{"mean", belief.mean}, {"variance", belief.variance}};
  }
  return out;
}

Json attributes_json(const ObjectBelief& object, const Background& background) {
  Json out = Json::object();
  const auto& attributes = background.knowledge.attributes;
  for (int a = 0; a < static_cast<int>(attributes.size()); ++a) {
    if (a == background.knowledge.class_attribute) {
      out["class"] = class_json(object.classes(background), background);
      continue;
    }
    const std::size_t symbols = attributes[a].symbols.size();
    std::vector<double> p(symbols, 0.0);
    double held = 0, mean = 0, second = 0;
    for (const auto& version : object.versions) {
      const double weight = version.weight(object.p);
      const AttributeBelief* belief = version.leaf.attribute(a);
      for (std::size_t s = 0; s < symbols; ++s)
        p[s] += weight * (belief ? belief->symbols[s] : 1.0 / static_cast<double>(symbols));
      if (!belief) continue;
      held += weight;
      mean += weight * belief->mean;
      second += weight * (belief->variance + belief->mean * belief->mean);
    }
    if (held <= 0) continue;
    if (attributes[a].kind == Attribute::Kind::kCategorical) {
      out[attributes[a].name] = symbols_json(p, attributes[a]);
    } else {
      mean /= held;
      out[attributes[a].name] = {
          {"mean", mean}, {"variance", second / held - mean * mean}, {"unit", attributes[a].unit}};
    }
  }
  return out;
}

Json models_json(const Leaf& leaf, const Background& background) {
  Json out = Json::object();
  const auto& models = background.object_class(leaf.model_class).models;
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    const char* kind = to_string(models[m].kind);
    out[kind] = out.value(kind, 0.0) + leaf.models[m].weight;
  }
  return out;
}

Json place_json(int place, const Background& background) {
  return place < 0 ? Json(nullptr) : Json(background.knowledge.places[place].name);
}

void add_shape(Json& to, const Leaf& leaf, const Background& background) {
  if (leaf.yaw) to["yaw"] = *leaf.yaw;
  const Eigen::Vector3d& extent = background.object_class(leaf.top_class()).extent;
  if (!extent.isZero()) to["extent"] = position_json(extent, 3);
}

void add_said(Json& to, const Anchor& anchor) {
  if (!anchor.alias.empty()) to["alias"] = anchor.alias;
  if (anchor.holder) to["held_by"] = *anchor.holder;
}

}  // namespace anchord
