#include "maintenance/roi.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/polygon.h"

namespace anchord {
namespace {

constexpr std::size_t kMostEllipsoids = 64;
constexpr std::size_t kMostPrisms = kMaxRegions - kMostEllipsoids;

/// Mass of a normal density within a Mahalanobis distance: the chi-square distribution of d
/// degrees of freedom, at its square.
double mass_within(double radius, int dims) {
  if (dims == 2) return -std::expm1(-0.5 * radius * radius);
  return std::erf(radius / std::numbers::sqrt2) -
         std::sqrt(2 / std::numbers::pi) * radius * std::exp(-0.5 * radius * radius);
}

constexpr double kLeastVariance = 1e-12;  // m^2: a micrometre

struct Bell {
  double weight;
  Gaussian density;
  double log_peak;  ///< ln of weight times density at its mean

  /// The distance to which weight times density is above a level.
  double radius(double log_level) const {
    return std::sqrt(std::max(0.0, 2 * (log_peak - log_level)));
  }
};

/// What there is of `somewhere` over one place, from all leaves.
struct Patch {
  const Footprint* footprint;
  double weight = 0;
  std::vector<double> mass;        ///< per cell
  std::vector<double> log_height;  ///< per cell: ln of its density
};

/// The components of an object's density.
struct Parts {
  std::vector<Bell> bells;
  std::vector<Patch> patches;

  double mass_above(double log_level, int dims) const {
    double sum = 0;
    for (const Bell& bell : bells) sum += bell.weight * mass_within(bell.radius(log_level), dims);
    for (const Patch& patch : patches)
      for (std::size_t i = 0; i < patch.log_height.size(); ++i)
        if (patch.log_height[i] >= log_level) sum += patch.mass[i];
    return sum;
  }

  double mass() const {
    double sum = 0;
    for (const Bell& bell : bells) sum += bell.weight;
    for (const Patch& patch : patches) sum += patch.weight;
    return sum;
  }

  void add(double weight, const Somewhere& somewhere) {
    const Footprint* f = somewhere.footprint().get();
    auto patch = std::find_if(patches.begin(), patches.end(),
                              [&](const Patch& other) { return other.footprint == f; });
    if (patch == patches.end())
      patch = patches.insert(patch, {f, 0, std::vector<double>(f->cells.size(), 0.0), {}});
    patch->weight += weight;
    for (std::size_t i = 0; i < patch->mass.size(); ++i)
      patch->mass[i] += weight * somewhere.mass_in(static_cast<int>(i));
  }
};

double log_peak(double weight, const Gaussian& g, int dims) {
  const double determinant =
      dims == 2 ? g.covariance.topLeftCorner<2, 2>().determinant() : g.covariance.determinant();
  return std::log(weight) - 0.5 * (dims * std::log(2 * std::numbers::pi) + std::log(determinant));
}

Parts parts_of(const ObjectBelief& object, const Background& background) {
  Parts parts;
  for (const auto& version : object.versions)
    for (const ModelState& model : version.leaf.models) {
      const double weight = version.weight(object.p) * model.weight;
      if (weight <= 0) continue;
      if (const auto* kinematic = std::get_if<Kinematic>(&model.density)) {
        Gaussian g = kinematic->position_density();
        // A density without width has no finite height.
        g.covariance.diagonal().head(background.dims).array() += kLeastVariance;
        const auto same = std::find_if(parts.bells.begin(), parts.bells.end(), [&](const Bell& b) {
          return b.density.mean == g.mean && b.density.covariance == g.covariance;
        });
        if (same == parts.bells.end())
          parts.bells.push_back({weight, g, 0});
        else
          same->weight += weight;
      } else {
        parts.add(weight, std::get<Somewhere>(model.density));
      }
    }
  // Of many only the heaviest: there may be so many regions and no more.
  std::stable_sort(parts.bells.begin(), parts.bells.end(),
                   [](const Bell& a, const Bell& b) { return a.weight > b.weight; });
  if (parts.bells.size() > kMostEllipsoids) parts.bells.resize(kMostEllipsoids);
  for (Bell& bell : parts.bells)
    bell.log_peak = log_peak(bell.weight, bell.density, background.dims);
  for (Patch& patch : parts.patches) {
    const Footprint& f = *patch.footprint;
    for (std::size_t i = 0; i < f.cells.size(); ++i)
      patch.log_height.push_back(std::log(patch.mass[i] / (f.share[i] * f.volume)));
  }
  return parts;
}

/// The greatest level (to bisection's accuracy, never above it) over which there is the mass `p`.
double level_for(double p, const Parts& parts, int dims) {
  double high = -std::numeric_limits<double>::infinity();
  for (const Bell& bell : parts.bells) high = std::max(high, bell.log_peak);
  for (const Patch& patch : parts.patches)
    for (const double height : patch.log_height) high = std::max(high, height);
  double step = 1, low = high;
  // 64 doublings reach every finite height.
  for (int i = 0; i < 64 && parts.mass_above(low, dims) < p; ++i) low -= step, step *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (parts.mass_above(middle, dims) >= p ? low : high) = middle;
  }
  return low;
}

RegionOfInterest ellipsoid(const Bell& bell, double radius, int dims) {
  RegionOfInterest roi;
  roi.kind = RegionOfInterest::Kind::kEllipsoid;
  roi.p = std::min(bell.weight * mass_within(radius, dims), 1.0);
  Eigen::Map<Eigen::Vector3d>(roi.center.data()) = bell.density.mean;
  Eigen::Map<Eigen::Matrix3d>(roi.covariance.data()) = bell.density.covariance;
  roi.radius = radius;
  return roi;
}

RegionOfInterest prism(const Polygon& polygon, const Footprint& f, double p) {
  RegionOfInterest roi;
  roi.kind = RegionOfInterest::Kind::kPrism;
  roi.p = std::min(p, 1.0);  // sums of rounded weights
  for (const Eigen::Vector2d& corner : polygon) roi.polygon.push_back({corner.x(), corner.y()});
  if (f.dims == 3) roi.z = {f.region.z_min, f.region.z_max};
  return roi;
}

/// The cells of a patch above a level, joined along rows.
std::vector<RegionOfInterest> prisms(const Patch& patch, double log_level) {
  const Footprint& f = *patch.footprint;
  std::vector<RegionOfInterest> rows;
  std::size_t taken = 0;
  int last = -2;  // grid index of the run's last cell
  Eigen::Vector3d low, high;
  double mass = 0;
  const auto close = [&] {
    if (mass > 0) rows.push_back(prism(part_in(f.region.polygon, low, high), f, mass));
    mass = 0;
  };
  for (int cell = 0; cell < f.grid.size(); ++cell) {
    const int i = f.position_of[cell];
    if (i < 0 || !(patch.log_height[i] >= log_level)) continue;
    ++taken;
    if (mass == 0 || cell != last + 1 || cell % f.grid.columns == 0) {
      close();
      low = f.grid.corner_min(cell);
    }
    high = f.grid.corner_max(cell);
    mass += patch.mass[i];
    last = cell;
  }
  close();
  if (taken == f.cells.size()) return {prism(f.region.polygon, f, patch.weight)};
  return rows;
}

}  // namespace

std::vector<RegionOfInterest> regions_of(const ObjectBelief& object, const Background& background,
                                         double p) {
  const Parts parts = parts_of(object, background);
  // What was left out cannot be covered.
  const double level = level_for(std::min(p, 0.999 * parts.mass()), parts, background.dims);
  std::vector<RegionOfInterest> out;
  for (const Bell& bell : parts.bells)
    if (const double radius = bell.radius(level); radius > 0)
      out.push_back(ellipsoid(bell, radius, background.dims));
  // Rows where there is room for them, else places as a whole, the heaviest first.
  std::vector<const Patch*> patches;
  for (const Patch& patch : parts.patches) patches.push_back(&patch);
  std::stable_sort(patches.begin(), patches.end(),
                   [](const Patch* a, const Patch* b) { return a->weight > b->weight; });
  std::size_t room = kMostPrisms, left = patches.size();
  for (const Patch* patch : patches) {
    auto rows = prisms(*patch, level);
    --left;
    if (rows.empty() || room == 0) continue;
    if (rows.size() + std::min(left, room - 1) > room)
      rows = {prism(patch->footprint->region.polygon, *patch->footprint, patch->weight)};
    room -= rows.size();
    out.insert(out.end(), rows.begin(), rows.end());
  }
  return out;
}

std::vector<AttributeReport> appearance_of(const ObjectBelief& object,
                                           const Background& background) {
  std::vector<AttributeReport> out;
  for (const AttributeBelief& belief : object.shown().attributes) {
    const Attribute& attribute =
        background.knowledge.attributes[static_cast<std::size_t>(belief.attribute)];
    if (attribute.kind == Attribute::Kind::kScalar) {
      out.push_back({attribute.name, ScalarReport{belief.mean, belief.variance}});
      continue;
    }
    SymbolReport report;
    for (std::size_t s = 0; s < belief.symbols.size(); ++s)
      report.probabilities.emplace_back(attribute.symbols[s], belief.symbols[s]);
    out.push_back({attribute.name, std::move(report)});
  }
  return out;
}

}  // namespace anchord
