#include "anchoring/background.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>

#include "geometry/gaussian_mass.h"

namespace anchord {
namespace {

/// Every class with a `somewhere`: an object that was looked for in vain, or that somebody moved,
/// must be somewhere. One that is not configured is never entered otherwise.
Knowledge with_somewhere(Knowledge knowledge) {
  for (ObjectClass& c : knowledge.classes) {
    const bool has = std::any_of(c.models.begin(), c.models.end(),
                                 [](const BehaviourModel& m) { return !m.tracked(); });
    if (has) continue;
    BehaviourModel lost;
    lost.kind = BehaviourModel::Kind::kSomewhere;
    lost.implied = true;
    c.models.push_back(lost);
  }
  return knowledge;
}

Background::SymbolChain chain_of(const AttributeChange& change) {
  Background::SymbolChain chain;
  for (const Transition& t : change.transitions)
    for (int symbol : {t.from, t.to}) chain.symbols.push_back(symbol);
  std::sort(chain.symbols.begin(), chain.symbols.end());
  chain.symbols.erase(std::unique(chain.symbols.begin(), chain.symbols.end()), chain.symbols.end());
  const auto n = static_cast<Eigen::Index>(chain.symbols.size());
  const auto place_of = [&](int symbol) {
    return std::lower_bound(chain.symbols.begin(), chain.symbols.end(), symbol) -
           chain.symbols.begin();
  };
  chain.rates = ModelMatrix::Zero(n, n);
  for (const Transition& t : change.transitions)
    chain.rates(place_of(t.from), place_of(t.to)) += t.rate;
  return chain;
}

Background::Dynamics dynamics_of(const ObjectClass& c) {
  // An implied model is the last.
  const int n = static_cast<int>(c.models.size()) - (c.models.back().implied ? 1 : 0);
  Background::Dynamics d;
  d.rates = ModelMatrix::Zero(n, n);
  for (int to = 0; to < n; ++to)
    if (!c.models[to].tracked())
      for (int from = 0; from < n; ++from)
        if (c.models[from].tracked()) d.rates(from, to) += c.models[to].rate;
  for (const Transition& t : c.transitions) {
    d.rates(t.from, t.to) += t.rate;
    const BehaviourModel &from = c.models[t.from], &to = c.models[t.to];
    if (t.rate > 0 && from.tracked() && to.tracked() && !from.moves_like(to)) d.exchanges = true;
  }
  d.moves = d.rates.maxCoeff() > 0;
  for (const AttributeChange& change : c.changes) d.changes.push_back(chain_of(change));
  const auto is_found_in = [](const BehaviourModel& m) {
    return m.tracked() && m.detectable && !m.shares();
  };
  while (!is_found_in(c.models[d.first_detectable])) ++d.first_detectable;
  return d;
}

/// The arrivals that are concentrated somewhere, spread over the cells; empty if there are none.
std::vector<double> concentrated(const ObjectClass& c, const Background& b) {
  if (std::all_of(c.arrivals.begin(), c.arrivals.end(),
                  [](const Arrival& a) { return a.motion.has_value(); }))
    return {};
  std::vector<double> rate(b.grid.size(), c.arrival_rate);
  const double volume = b.cell_volume();
  for (const Arrival& a : c.arrivals) {
    if (a.motion) continue;  // theirs is an intensity that moves
    const auto* place = a.place >= 0 ? b.footprint(a.place).get() : nullptr;
    for (int cell = 0; cell < b.grid.size(); ++cell) {
      const Eigen::Vector3d low = b.grid.corner_min(cell), high = b.grid.corner_max(cell);
      if (!place) {
        rate[cell] += a.rate * mass({a.mean, a.covariance}, box(low, high), b.dims) / volume;
        continue;
      }
      const int local = place->grid.index(0.5 * (low + high));
      const int i = local < 0 ? -1 : place->position_of[local];
      if (i >= 0) rate[cell] += a.rate * place->share[i] / volume;
    }
  }
  return rate;
}

/// The arrivals that move before they are seen.
MovingArrivals moving(const ObjectClass& c, int first_detectable, int dims) {
  const BehaviourModel& model = c.models[first_detectable];
  MovingArrivals out;
  out.constant_velocity = model.kind == BehaviourModel::Kind::kConstantVelocity;
  out.psd = model.psd;
  out.departure_rate = c.departure_rate;
  out.dims = dims;
  for (const Arrival& a : c.arrivals) {
    if (!a.motion) continue;
    MovingArrivals::Source source;
    source.density =
        kinematic_at({a.mean, a.covariance},
                     out.constant_velocity ? model.initial_velocity_variance : ByAxis(), dims);
    // A class that took arrivals from the default may have a model without velocity.
    if (out.constant_velocity) {
      source.density.velocity = a.motion->velocity;
      source.density.vv = a.motion->velocity_covariance.value_or(source.density.vv);
    }
    source.rate = a.rate;
    source.at_start = a.motion->at_start;
    out.sources.push_back(source);
  }
  return out;
}

}  // namespace

Background::Background(Knowledge k)
    : knowledge(with_somewhere(std::move(k))),
      dims(knowledge.dims),
      grid(Grid::over(knowledge.bounds_min, knowledge.bounds_max, knowledge.cell)),
      tiling(std::make_shared<Tiling>(grid)),
      walls(knowledge.walls) {
  footprints_.push_back(std::make_shared<Footprint>(Footprint::of(knowledge.world(), grid, dims)));
  for (const Place& place : knowledge.places)
    footprints_.push_back(std::make_shared<Footprint>(Footprint::of(place.region, grid, dims)));
  compare_places();
  number_places();
  const auto falls = [](const Sensor& sensor) {
    return std::any_of(sensor.detection_probability.begin(), sensor.detection_probability.end(),
                       [](const DetectionProbability& p) { return p.per_m != 0; });
  };
  ranged = falls(knowledge.default_sensor) ||
           std::any_of(knowledge.sensors.begin(), knowledge.sensors.end(), falls);
  for (const ObjectClass& c : knowledge.classes) {
    dynamics.push_back(dynamics_of(c));
    largest_extent = std::max(largest_extent, c.extent.norm());
    shares = shares || std::any_of(c.models.begin(), c.models.end(),
                                   [](const BehaviourModel& m) { return m.shares(); });
    has_phantoms = has_phantoms || c.phantom;
    arrivals.push_back(std::make_shared<ArrivalModel>(ArrivalModel{
        c.undetected_intensity, c.departure_rate, c.arrival_rate, concentrated(c, *this)}));
    moving_arrivals.push_back(
        std::make_shared<MovingArrivals>(moving(c, dynamics.back().first_detectable, dims)));
  }
  if (std::all_of(moving_arrivals.begin(), moving_arrivals.end(),
                  [](const auto& m) { return m->sources.empty(); }))
    moving_arrivals.clear();
  const double gate = knowledge.limits.gate_probability;
  gate_distance2 = gate < 1 ? boost::math::quantile(boost::math::chi_squared(dims), gate)
                            : std::numeric_limits<double>::infinity();
  const double least = knowledge.limits.min_weight;
  log_least_weight = std::log(least);
  constexpr double kFarthest = 8;  // beyond lies 6e-16
  sight_deviations = kFarthest;
  if (least > 0) {
    const auto at = boost::math::quantile(boost::math::complement(boost::math::normal(), least));
    sight_deviations = std::clamp(at, 0.0, kFarthest);
  }
}

/// Those that a behaviour model looks for objects in have bits of their own, as far as they go.
void Background::number_places() {
  constexpr std::size_t kBits = 64;
  for (const ObjectClass& c : knowledge.classes)
    for (const BehaviourModel& model : c.models) {
      const Footprint* place = footprint(model.place).get();
      if (!model.tracked() && !model.implied &&
          std::find(searched_.begin(), searched_.end(), place) == searched_.end())
        searched_.push_back(place);
    }
  for (const auto& place : footprints_) bits_[place.get()] = std::uint64_t{1} << (kBits - 1);
  for (std::size_t i = 0; i < std::min(searched_.size(), kBits - 1); ++i)
    bits_[searched_[i]] = std::uint64_t{1} << i;
}

std::uint64_t Background::places_in(const std::array<double, 4>& box) const {
  std::uint64_t bits = 0;
  for (const auto& footprint : footprints_) {
    const Grid& cells = footprint->grid;
    const Eigen::Vector3d low = cells.corner_min(0), high = cells.corner_max(cells.size() - 1);
    if (low.x() <= box[2] && low.y() <= box[3] && high.x() >= box[0] && high.y() >= box[1])
      bits |= bit_of(*footprint);
  }
  return bits;
}

int Background::place_of(const Footprint& footprint) const {
  const auto it = std::find_if(footprints_.begin(), footprints_.end(),
                               [&](const auto& kept) { return kept.get() == &footprint; });
  return static_cast<int>(it - footprints_.begin()) - 1;
}

void Background::compare_places() {
  constexpr double kEdge = 1e-6;  // of a place's volume: shared edges are no overlap
  const auto& places = knowledge.places;
  for (std::size_t f = 0; f < footprints_.size(); ++f) {
    const Footprint& footprint = *footprints_[f];
    auto& overlaps = overlaps_[&footprint];
    std::vector<double> any(footprint.cells.size(), 0.0);
    for (std::size_t other = 0; other < footprints_.size(); ++other) {
      overlaps.emplace_back(footprint.overlap(footprints_[other]->region), footprint);
      if (other == 0) continue;
      double shared = 0;
      for (std::size_t i = 0; i < any.size(); ++i) {
        shared += overlaps.back()[i] * footprint.share[i];
        any[i] = places[other - 1].parent < 0 ? std::min(1.0, any[i] + overlaps.back()[i])
                                              : std::max(any[i], overlaps.back()[i]);
      }
      if (f == 0 || f == other) continue;
      const bool both_outermost = places[f - 1].parent < 0 && places[other - 1].parent < 0;
      const bool inner = places[f - 1].parent == static_cast<int>(other) - 1;
      if ((both_outermost && shared > kEdge) || (inner && shared < 1 - kEdge)) places_nest_ = false;
    }
    overlaps_any_[&footprint] = {std::move(any), footprint};
  }
}

}  // namespace anchord
