#include "anchoring/leaf_event.h"

#include <algorithm>
#include <iterator>

namespace anchord {
namespace {

/// How much of a place is all of it, to rounding.
constexpr double kAll = 1e-9;

/// A `somewhere` of a class, and its share of what is lost: as much as it takes of what the tracked
/// models lose anyway.
struct Exit {
  std::size_t model = 0;
  double share = 0;
};

/// Those of a class: every class has one.
std::vector<Exit> exits_among(const std::vector<BehaviourModel>& models) {
  std::vector<Exit> exits;
  double rates = 0;
  for (std::size_t m = 0; m < models.size(); ++m)
    if (!models[m].tracked()) {
      exits.push_back({m, models[m].rate});
      rates += models[m].rate;
    }
  for (Exit& exit : exits)
    exit.share = rates > 0 ? exit.share / rates : 1 / static_cast<double>(exits.size());
  return exits;
}

/// A model of a leaf; one that its class only implies is made.
ModelState& model_of(Leaf& leaf, std::size_t m, const Background& background) {
  const auto& models = background.object_class(leaf.model_class).models;
  if (m == leaf.models.size())
    leaf.models.push_back({0, Somewhere(background.footprint(models[m].place))});
  return leaf.models[m];
}

Kinematic at_rest(const Gaussian& at, const BehaviourModel& model, int dims) {
  const bool moving = model.kind == BehaviourModel::Kind::kConstantVelocity;
  return kinematic_at(at, moving ? model.initial_velocity_variance : ByAxis(), dims);
}

/// Weight that enters a tracked model, from a density of these moments.
void follow(ModelState& tracked, double weight, const Gaussian& moments,
            const BehaviourModel& model, int dims) {
  if (weight <= 0) return;
  auto& density = std::get<Kinematic>(tracked.density);
  const Kinematic arriving = at_rest(moments, model, dims);
  density = tracked.weight > 0 ? merge(tracked.weight, density, weight, arriving) : arriving;
  tracked.seen = tracked.weight > 0
                     ? SeenShare::merge(tracked.weight, tracked.seen, weight, SeenShare())
                     : SeenShare();
  tracked.weight += weight;
}

template <typename Values>
void multiply(Values& values, const Values& by) {
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += values[i] * by[i];
  if (sum <= 0) return;  // they contradict each other: the first stands
  for (std::size_t i = 0; i < values.size(); ++i) values[i] *= by[i] / sum;
}

}  // namespace

const CellShares& LookedAt::of(const Footprint& footprint) {
  const auto [it, made] = shares_.try_emplace(&footprint);
  if (!made) return it->second;
  std::vector<double> share(footprint.cells.size(), 0.0);
  for (const Region& region : regions_) {
    const auto part = footprint.overlap(region);
    for (std::size_t i = 0; i < share.size(); ++i) share[i] = std::min(share[i] + part[i], 1.0);
  }
  return it->second = {std::move(share), footprint};
}

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
  std::vector<Exit> exits = exits_among(models);
  if (place >= 0) exits = {{exits.front().model, 1}};
  for (ModelState& state : leaf.models) state.weight = 0;
  const Exit* main = &exits.front();
  for (const Exit& exit : exits) {
    const int there = place >= 0 ? place : models[exit.model].place;
    model_of(leaf, exit.model, background) = {exit.share, Somewhere(background.footprint(there))};
    if (exit.share > main->share) main = &exit;
  }
  const Gaussian moments = std::get<Somewhere>(leaf.models[main->model].density).moments();
  for (std::size_t m = 0; m < leaf.models.size(); ++m)
    if (models[m].tracked()) leaf.models[m] = {0, at_rest(moments, models[m], background.dims)};
}

void lose(Leaf& leaf, const Sensor& sensor, LookedAt& looked_at, const Background& background) {
  if (leaf.held) return;
  const auto& models = background.object_class(leaf.model_class).models;
  std::vector<Exit> exits = exits_among(models);
  std::vector<Somewhere> elsewhere;
  double open = 0;  // shares of the exits that were not looked at all over
  for (Exit& exit : exits) {
    const auto& own = background.footprint(models[exit.model].place);
    const auto& inside = looked_at.of(*own);
    Somewhere& density = elsewhere.emplace_back(own);
    if (density.mass(inside) >= 1 - kAll)
      exit.share = 0;
    else
      density.miss(1, inside);
    open += exit.share;
  }
  if (open <= 0) return;
  double p = 0;
  for (std::size_t c = 0; c < leaf.classes.size(); ++c)
    p += leaf.classes[c] * sensor.detection_probability[c].near;

  double moved = 0;
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    if (!models[m].tracked() || !models[m].detectable) continue;
    moved += leaf.models[m].weight * p;
    leaf.models[m].weight *= 1 - p;
  }
  // A place that an event told is in the first exit.
  ModelState& first = model_of(leaf, exits.front().model, background);
  const auto& first_own = background.footprint(models[exits.front().model].place);
  const Somewhere there = std::get<Somewhere>(first.density);
  const double told = there.footprint() == first_own ? 0.0 : first.weight;
  const double seen = told > 0 ? p * there.mass(looked_at.of(*there.footprint())) : 0.0;
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    auto* somewhere = std::get_if<Somewhere>(&leaf.models[m].density);
    if (somewhere && models[m].detectable && leaf.models[m].weight > 0)
      somewhere->miss(p, looked_at.of(*somewhere->footprint()));
  }
  if (told > 0) {
    moved += told * seen;
    const Gaussian rest_of_it = std::get<Somewhere>(first.density).moments();
    first = {0, Somewhere(first_own)};
    const int home = background.dynamics[leaf.model_class].first_detectable;
    follow(leaf.models[home], told * (1 - seen), rest_of_it, models[home], background.dims);
  }
  if (moved <= 0) return;
  for (std::size_t i = 0; i < exits.size(); ++i) {
    const double entering = moved * exits[i].share / open;
    if (entering <= 0) continue;
    ModelState& lost = leaf.models[exits[i].model];
    auto& density = std::get<Somewhere>(lost.density);
    density = lost.weight > 0 ? Somewhere::merge(lost.weight, density, entering, elsewhere[i])
                              : elsewhere[i];
    lost.weight += entering;
  }
}

Leaf fuse(const Leaf& a, const Leaf& b, const Background& background) {
  const bool a_tells = a.held != b.held ? a.held : a.last_seen >= b.last_seen;
  Leaf out = a_tells ? a : b;
  const Leaf& other = a_tells ? b : a;
  out.last_seen = std::max(a.last_seen, b.last_seen);
  out.existence = 1 - (1 - a.existence) * (1 - b.existence);
  multiply(out.classes, other.classes);
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
