#include "anchoring/leaf_event.h"

#include <algorithm>
#include <iterator>

namespace anchord {
namespace {

/// How much of a place is all of it, to rounding.
constexpr double kAll = 1e-9;

/// The model of a class that is a `somewhere`, the first: every class has one.
std::size_t somewhere_among(const std::vector<BehaviourModel>& models) {
  std::size_t m = 0;
  while (models[m].tracked()) ++m;
  return m;
}

/// That of a leaf; one that its class only implies is made.
ModelState& somewhere_of(Leaf& leaf, const Background& background) {
  const auto& models = background.object_class(leaf.model_class).models;
  const std::size_t m = somewhere_among(models);
  if (m == leaf.models.size())
    leaf.models.push_back({0, Somewhere(background.footprint(models[m].place))});
  return leaf.models[m];
}

/// Per cell of a footprint the share that was looked at.
std::vector<double> looked_at(const Footprint& footprint, const std::vector<Region>& regions) {
  std::vector<double> share(footprint.cells.size(), 0.0);
  for (const Region& region : regions) {
    const auto part = footprint.overlap(region);
    for (std::size_t i = 0; i < share.size(); ++i) share[i] = std::min(share[i] + part[i], 1.0);
  }
  return share;
}

Kinematic at_rest(const Gaussian& at, const BehaviourModel& model, int dims) {
  const bool moving = model.kind == BehaviourModel::Kind::kConstantVelocity;
  return kinematic_at(at, moving ? model.initial_velocity_variance : 0.0, dims);
}

/// Weight that enters a tracked model, from a density of these moments.
void follow(ModelState& tracked, double weight, const Gaussian& moments,
            const BehaviourModel& model, int dims) {
  if (weight <= 0) return;
  auto& density = std::get<Kinematic>(tracked.density);
  const Kinematic arriving = at_rest(moments, model, dims);
  density = tracked.weight > 0 ? merge(tracked.weight, density, weight, arriving) : arriving;
  tracked.weight += weight;
}

void multiply(std::vector<double>& values, const std::vector<double>& by) {
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += values[i] * by[i];
  if (sum <= 0) return;  // they contradict each other: the first stands
  for (std::size_t i = 0; i < values.size(); ++i) values[i] *= by[i] / sum;
}

}  // namespace

void put_at(Leaf& leaf, const Gaussian& at, const Background& background) {
  const int target = background.dynamics[leaf.model_class].first_detectable;
  const BehaviourModel& model = background.object_class(leaf.model_class).models[target];
  for (ModelState& state : leaf.models) state.weight = 0;
  leaf.models[target] = {1, at_rest(at, model, background.dims)};
}

void rest(Leaf& leaf, const Background& background) {
  const auto& models = background.object_class(leaf.model_class).models;
  for (std::size_t m = 0; m < leaf.models.size(); ++m)
    if (auto* kinematic = std::get_if<Kinematic>(&leaf.models[m].density))
      *kinematic = at_rest(kinematic->position_density(), models[m], background.dims);
}

void put_somewhere(Leaf& leaf, int place, const Background& background) {
  const auto& models = background.object_class(leaf.model_class).models;
  if (place < 0) place = models[somewhere_among(models)].place;
  const Somewhere there(background.footprint(place));
  const Gaussian moments = there.moments();
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    leaf.models[m].weight = 0;
    if (models[m].tracked()) leaf.models[m].density = at_rest(moments, models[m], background.dims);
  }
  somewhere_of(leaf, background) = {1, there};
}

void lose(Leaf& leaf, const MapEvent& missing, const Background& background) {
  if (leaf.held) return;
  const auto& models = background.object_class(leaf.model_class).models;
  const auto& own = background.footprint(models[somewhere_among(models)].place);
  const auto inside = looked_at(*own, missing.looked_at);
  Somewhere elsewhere(own);
  if (elsewhere.mass(inside) >= 1 - kAll) return;
  elsewhere.miss(1, inside);
  double p = 0;
  for (std::size_t c = 0; c < leaf.classes.size(); ++c)
    p += leaf.classes[c] * missing.sensor->detection_probability[c];

  double moved = 0;
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    if (!models[m].tracked() || !models[m].detectable) continue;
    moved += leaf.models[m].weight * p;
    leaf.models[m].weight *= 1 - p;
  }
  ModelState& lost = somewhere_of(leaf, background);
  auto& density = std::get<Somewhere>(lost.density);
  if (lost.weight > 0 && density.footprint() != own) {
    const auto seen = looked_at(*density.footprint(), missing.looked_at);
    const double share = p * density.mass(seen);
    moved += lost.weight * share;
    density.miss(p, seen);
    const int home = background.dynamics[leaf.model_class].first_detectable;
    follow(leaf.models[home], lost.weight * (1 - share), density.moments(), models[home],
           background.dims);
    lost = {0, Somewhere(own)};
  } else if (lost.weight > 0) {
    density.miss(p, inside);
  }
  if (moved <= 0) return;
  density = lost.weight > 0 ? Somewhere::merge(lost.weight, density, moved, elsewhere) : elsewhere;
  lost.weight += moved;
}

Leaf fuse(const Leaf& a, const Leaf& b, const Background& background) {
  const bool a_tells = a.held != b.held ? a.held : a.last_seen >= b.last_seen;
  Leaf out = a_tells ? a : b;
  const Leaf& other = a_tells ? b : a;
  out.last_seen = std::max(a.last_seen, b.last_seen);
  out.existence = 1 - (1 - a.existence) * (1 - b.existence);
  std::vector<double> classes(out.classes.begin(), out.classes.end());
  multiply(classes, {other.classes.begin(), other.classes.end()});
  out.classes.assign(classes.begin(), classes.end());
  for (const AttributeBelief& belief : other.attributes) {
    auto at = std::lower_bound(
        out.attributes.begin(), out.attributes.end(), belief.attribute,
        [](const AttributeBelief& x, int attribute) { return x.attribute < attribute; });
    if (at == out.attributes.end() || at->attribute != belief.attribute) {
      out.attributes.insert(at, belief);
    } else if (!at->symbols.empty()) {
      multiply(at->symbols, belief.symbols);
    } else {
      const double gain = at->variance / (at->variance + belief.variance);
      at->mean += gain * (belief.mean - at->mean);
      at->variance *= 1 - gain;
    }
  }
  if (!out.yaw) out.yaw = other.yaw;
  out.recent.clear();
  std::set_union(a.recent.begin(), a.recent.end(), b.recent.begin(), b.recent.end(),
                 std::back_inserter(out.recent));
  follow_class(out, background);
  return out;
}

}  // namespace anchord
