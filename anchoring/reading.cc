#include "anchoring/reading.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

#include "geometry/gaussian_mass.h"
#include "geometry/standard_normal.h"

namespace anchord {
namespace {

double predicate_probability(const AttributeBelief& belief, const Predicate& predicate) {
  const double sigma = std::sqrt(belief.variance);
  return normal_between((predicate.min - belief.mean) / sigma,
                        (predicate.max - belief.mean) / sigma);
}

/// The mass of a density in the union of all places. Where outermost places are disjoint and hold
/// their inner ones, the sum over the outermost; else by equally probable points.
double mass_in_any_place(const Gaussian& density, const Background& background) {
  const auto& places = background.knowledge.places;
  if (background.places_nest()) {
    double sum = 0;
    for (const Place& place : places)
      if (place.parent < 0) sum += mass(density, place.region, background.dims);
    return std::min(sum, 1.0);
  }
  constexpr int kSteps = 11;
  const int depth = background.dims == 3 ? kSteps : 1;
  const auto quantile = [](int i) {
    return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * (i + 0.5) / kSteps);
  };
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(density.covariance);
  const Eigen::Vector3d spread = axes.eigenvalues().cwiseMax(0).cwiseSqrt();
  int inside = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j)
      for (int k = 0; k < depth; ++k) {
        // Eigenvalues ascend: in a 2-D world the first is the absent axis.
        const Eigen::Vector3d u(depth > 1 ? quantile(k) : 0.0, quantile(i), quantile(j));
        const Eigen::Vector3d x = density.mean + axes.eigenvectors() * spread.cwiseProduct(u);
        inside += std::any_of(places.begin(), places.end(), [&](const Place& place) {
          return place.region.contains(x, background.dims);
        });
      }
  return static_cast<double>(inside) / (kSteps * kSteps * depth);
}

}  // namespace

double match(const Leaf& leaf, const Description& description, const Background& background) {
  double p = 1;
  for (const auto& term : description.terms) {
    const Attribute& attribute = background.knowledge.attributes[term.attribute];
    if (term.attribute == background.knowledge.class_attribute) {
      p *= leaf.classes[term.symbol];
      continue;
    }
    const AttributeBelief* belief = leaf.attribute(term.attribute);
    if (attribute.kind == Attribute::Kind::kCategorical)
      p *= belief ? belief->symbols[term.symbol]
                  : 1.0 / static_cast<double>(attribute.symbols.size());
    else
      p *= belief ? predicate_probability(*belief, attribute.predicates[term.symbol]) : 0.0;
  }
  return p;
}

double match(const ObjectBelief& object, const Description& description,
             const Background& background) {
  double p = 0;
  for (const auto& version : object.versions)
    p += version.weight(object.p) * match(version.leaf, description, background);
  return p;
}

const Kinematic& position_of(const Leaf& leaf) {
  return std::get<Kinematic>(leaf.models[leaf.top_model()].density);
}

Eigen::Vector3d velocity_of(const Leaf& leaf, const Background& background) {
  const auto& models = background.object_class(leaf.model_class).models;
  if (models[leaf.top_model()].shares()) return Eigen::Vector3d::Zero();
  return position_of(leaf).velocity;
}

Gaussian moments(const Leaf& leaf) {
  Gaussian sum;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  // About the best position: positions may be far from the origin.
  const Eigen::Vector3d about = position_of(leaf).position;
  for (const ModelState& model : leaf.models) {
    if (model.weight <= 0) continue;
    const auto* kinematic = std::get_if<Kinematic>(&model.density);
    const Gaussian g =
        kinematic ? kinematic->position_density() : std::get<Somewhere>(model.density).moments();
    const Eigen::Vector3d d = g.mean - about;
    sum.mean += model.weight * d;
    second += model.weight * (g.covariance + d * d.transpose());
  }
  sum.covariance = second - sum.mean * sum.mean.transpose();
  sum.mean += about;
  return sum;
}

namespace {

double mass_in_place(const ModelState& model, int place, const Background& background) {
  if (const auto* kinematic = std::get_if<Kinematic>(&model.density))
    return mass(kinematic->position_density(), background.footprint(place)->region,
                background.dims);
  const auto& somewhere = std::get<Somewhere>(model.density);
  return somewhere.mass(background.overlap(*somewhere.footprint(), place));
}

}  // namespace

double mass_in_place(const Leaf& leaf, int place, const Background& background) {
  double sum = 0;
  for (const ModelState& model : leaf.models)
    if (model.weight > 0) sum += model.weight * mass_in_place(model, place, background);
  return std::min(sum, 1.0);
}

double mass_outside_places(const Leaf& leaf, const Background& background) {
  double inside = 0;
  for (const ModelState& model : leaf.models) {
    if (model.weight <= 0) continue;
    const auto* kinematic = std::get_if<Kinematic>(&model.density);
    inside +=
        model.weight *
        (kinematic
             ? mass_in_any_place(kinematic->position_density(), background)
             : std::get<Somewhere>(model.density)
                   .mass(background.overlap_any(*std::get<Somewhere>(model.density).footprint())));
  }
  return std::clamp(1 - inside, 0.0, 1.0);
}

double ObjectBelief::outside_places(const Background& background) const {
  double sum = 0;
  for (const Version& version : versions)
    sum += version.weight(p) * mass_outside_places(version.leaf, background);
  return std::min(sum, 1.0);
}

Gaussian ObjectBelief::moments(const Background&) const {
  Gaussian sum;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  const Eigen::Vector3d about = position_of(versions.front().leaf).position;
  for (const Version& version : versions) {
    const Gaussian g = ::anchord::moments(version.leaf);
    const Eigen::Vector3d d = g.mean - about;
    sum.mean += version.weight(p) * d;
    second += version.weight(p) * (g.covariance + d * d.transpose());
  }
  sum.covariance = second - sum.mean * sum.mean.transpose();
  sum.mean += about;
  return sum;
}

double ObjectBelief::in_place(int place, const Background& background) const {
  double sum = 0;
  for (const Version& version : versions)
    sum += version.weight(p) * mass_in_place(version.leaf, place, background);
  return std::min(sum, 1.0);
}

/// The likeliest version first, and as much of the density as it takes to tell.
bool ObjectBelief::mostly_in(int place, const Background& background) const {
  const Leaf* const first = &shown();
  double in = 0, out = 0;
  const auto told = [&] { return in >= 0.5 || out > 0.5; };
  const auto look = [&](const Version& version) {
    const double weight = version.weight(p);
    for (auto model = version.leaf.models.begin(); model != version.leaf.models.end() && !told();
         ++model) {
      const double mass = weight * model->weight;
      if (mass <= 0) continue;
      const double inside = mass * mass_in_place(*model, place, background);
      in += inside;
      out += mass - inside;
    }
  };
  for (const Version& version : versions)
    if (&version.leaf == first) look(version);
  for (const Version& version : versions)
    if (&version.leaf != first && !told()) look(version);
  return in >= 0.5;
}

int ObjectBelief::place(const Background& background) const {
  const auto& places = background.knowledge.places;
  int deepest = -1;
  for (int i = 0; i < static_cast<int>(places.size()); ++i)
    if ((deepest < 0 || places[i].depth > places[deepest].depth) && mostly_in(i, background))
      deepest = i;
  return deepest;
}

std::vector<double> ObjectBelief::classes(const Background& background) const {
  std::vector<double> b(background.classes(), 0.0);
  for (const Version& version : versions)
    for (std::size_t c = 0; c < b.size(); ++c) b[c] += version.weight(p) * version.leaf.classes[c];
  return b;
}

const Leaf& ObjectBelief::shown() const {
  if (best >= 0) return versions[best].leaf;
  return std::max_element(
             versions.begin(), versions.end(),
             [&](const Version& a, const Version& b) { return a.weight(p) < b.weight(p); })
      ->leaf;
}

Utime ObjectBelief::last_seen() const { return shown().last_seen; }

std::vector<double> count_distribution(const Belief& belief, Utime at,
                                       const Description& description, int place,
                                       const Background& background) {
  constexpr double kLeast = 1e-15;
  const auto convolve = [](const std::vector<double>& x, const std::vector<double>& y) {
    std::vector<double> z(x.size() + y.size() - 1, 0.0);
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t j = 0; j < y.size(); ++j) z[i + j] += x[i] * y[j];
    while (z.size() > 1 && z.back() < kLeast) z.pop_back();
    return z;
  };
  std::vector<double> total{1.0};
  for (const auto& cluster : belief.clusters) {
    // Per anchor and leaf: the probability that it counts, if the leaf is the true one.
    std::vector<std::vector<double>> counts(cluster->anchors.size());
    for (std::size_t a = 0; a < cluster->anchors.size(); ++a)
      for (const auto& stored : cluster->anchors[a].leaves) {
        const Leaf leaf = leaf_at(*stored, at, background);
        double p = leaf.existence * match(leaf, description, background);
        if (p > 0 && place >= 0) p *= mass_in_place(leaf, place, background);
        counts[a].push_back(std::min(p, 1.0));
      }
    std::vector<double> mixed{0.0};
    for (const Hypothesis& h : cluster->hypotheses) {
      std::vector<double> number{1.0};
      for (std::size_t a = 0; a < h.leaf.size(); ++a)
        if (h.leaf[a] != Hypothesis::kNoLeaf && counts[a][h.leaf[a]] > 0)
          number = convolve(number, {1 - counts[a][h.leaf[a]], counts[a][h.leaf[a]]});
      if (mixed.size() < number.size()) mixed.resize(number.size(), 0.0);
      for (std::size_t n = 0; n < number.size(); ++n)
        mixed[n] += std::exp(h.log_weight) * number[n];
    }
    total = convolve(total, mixed);
  }
  return total;
}

double undetected(const Belief& belief, Utime at, const Description& description, int place,
                  const Background& background) {
  const Footprint& world = *background.footprint(-1);
  const auto& overlap = background.overlap(world, place);
  const double time = belief.frames == 0 ? 0 : belief.seconds(at);
  double sum = 0;
  for (int c = 0; c < background.classes(); ++c) {
    double share = background.object_class(c).phantom ? 0 : 1;
    for (const auto& term : description.terms) {
      const Attribute& attribute = background.knowledge.attributes[term.attribute];
      if (term.attribute == background.knowledge.class_attribute)
        share *= term.symbol == c ? 1 : 0;
      else
        share *= attribute.kind == Attribute::Kind::kCategorical
                     ? 1.0 / static_cast<double>(attribute.symbols.size())
                     : 0.0;
    }
    if (share == 0) continue;
    double number = 0;
    for (std::size_t i = 0; i < world.cells.size(); ++i)
      if (overlap[i] > 0)
        number += belief.undetected[c].at(world.cells[i], time) * overlap[i] * world.share[i];
    sum += share * number * world.volume;
    if (belief.moving.empty()) continue;
    MovingIntensity moving = belief.moving[c];
    moving.advance(time);
    sum += share * moving.expected(background.footprint(place)->region);
  }
  return sum;
}

}  // namespace anchord
