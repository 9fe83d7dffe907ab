#include "anchoring/occlusion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/standard_normal.h"

namespace anchord {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFar = 5;        // standard deviations; beyond them lies 6e-7
constexpr double kHidden = 1e-9;  // of a chance to be seen: what else hides it does not matter
constexpr double kBeside = 0.05;  // of the distance: corners beside the eye count as this far ahead
constexpr double kLeast = 1e-12;  // m^2, of a variance: an exact position is a step

double spread(const Eigen::Matrix3d& covariance) { return kFar * std::sqrt(covariance.trace()); }

double variance_along(const Eigen::Vector3d& axis, const Eigen::Matrix3d& covariance) {
  return axis.dot(covariance * axis);
}

/// An upright prism about an object's centre: half of its edges, and its axes. One without a known
/// yaw is turned to the eye.
struct Prism {
  Eigen::Vector3d half;
  Eigen::Matrix3d axes;
};

Prism prism_of(const Eigen::Vector3d& extent, const std::optional<double>& yaw,
               const Eigen::Vector3d& across) {
  Prism prism;
  prism.half = 0.5 * extent;
  Eigen::Vector3d length(across.y(), -across.x(), 0);
  if (yaw)
    length = {std::cos(*yaw), std::sin(*yaw), 0};
  else
    prism.half.x() = prism.half.y() = 0.5 * std::max(extent.x(), extent.y());
  prism.axes << length, Eigen::Vector3d(-length.y(), length.x(), 0), Eigen::Vector3d::UnitZ();
  return prism;
}

/// How far the line through its centre along u is inside, from the centre on.
double half_depth(const Prism& prism, const Eigen::Vector3d& u) {
  double depth = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double part = std::abs(u.dot(prism.axes.col(i)));
    if (part > 0 && prism.half[i] > 0) depth = std::min(depth, prism.half[i] / part);
  }
  return depth;
}

/// A box around an eye and what is in view, and `more` around that.
std::array<double, 4> between(const Eigen::Vector3d& eye, const std::array<double, 4>& view,
                              double more) {
  return {std::min(view[0], eye.x()) - more, std::min(view[1], eye.y()) - more,
          std::max(view[2], eye.x()) + more, std::max(view[3], eye.y()) + more};
}

/// Whether a density is as good as nowhere in a box.
bool outside(const Kinematic& density, const std::array<double, 4>& box) {
  for (int i = 0; i < 2; ++i) {
    const double reach = kFar * std::sqrt(density.pp(i, i));
    if (density.position[i] + reach < box[i] || density.position[i] - reach > box[i + 2])
      return true;
  }
  return false;
}

}  // namespace

Occlusion::Occlusion(const Belief& belief, const MapFrame& frame, const Background& background)
    : dims_(background.dims) {
  if (!frame.eye || frame.view.sees_nothing() || background.largest_extent == 0) return;
  eye_ = *frame.eye;
  const auto seen = frame.view.bounds();
  Window window =
      Window::of(frame.utime, between(eye_, seen, background.largest_extent), kFar, 0, background);
  window.places = 0;  // what may be somewhere hides nothing
  const auto may_hide = [&](const Reach& reach) { return reach.meets(window); };
  belief.clusters.visit(may_hide, [&](Clusters::Place, const auto& cluster) {
    for (std::size_t a = 0; a < cluster->anchors.size(); ++a) {
      const Leaf* leaf = cluster->best_leaf(static_cast<int>(a));
      if (!leaf || leaf->held || real_existence(*leaf, background) < kBelievedIn) continue;
      const Leaf real = as_real(*leaf, background);
      const Eigen::Vector3d& extent = background.object_class(real.top_class()).extent;
      if (extent.isZero(0)) continue;
      Leaf now = *leaf;
      predict(now, frame.utime, background);
      now = as_real(std::move(now), background);
      const auto& density = std::get<Kinematic>(now.models[now.top_model()].density);
      if (outside(density, between(eye_, seen, extent.norm()))) continue;
      const double p =
          cluster->existence(static_cast<int>(a), background) * now.existence / real.existence;
      add(now, cluster->anchors[a].anchor->birth, p, background);
    }
  });
  sort_into_bins();
}

void Occlusion::add(const Leaf& leaf, std::uint64_t birth, double p, const Background& background) {
  const ModelState& model = leaf.models[leaf.top_model()];
  const auto& density = std::get<Kinematic>(model.density);
  const Eigen::Vector3d& extent = background.object_class(leaf.top_class()).extent;
  Body body;
  body.birth = birth;
  body.p = std::min(p, 1.0) * model.weight;
  const Eigen::Vector3d centre = density.position - eye_;
  body.distance = centre.norm();
  if (!(body.distance > 0)) return;
  const Eigen::Vector3d u = centre / body.distance;
  const double level = u.head<2>().norm();
  constexpr double kUpright = 1e-9;  // of the level part of a line of sight that has none
  const Eigen::Vector3d across = level > kUpright
                                     ? Eigen::Vector3d(-u.y() / level, u.x() / level, 0)
                                     : Eigen::Vector3d::UnitY();
  body.axis = {u, across, u.cross(across)};
  const Prism prism = prism_of(extent, leaf.yaw, across);
  body.depth = half_depth(prism, u);
  if (!(body.depth < body.distance)) return;  // the eye is inside
  for (int i = 0; i < 3; ++i) body.variance[i] = variance_along(body.axis[i], density.pp);
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sides(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const Eigen::Vector3d at = centre + prism.axes * prism.half.cwiseProduct(sides);
    const double scale = body.distance / std::max(at.dot(u), kBeside * body.distance);
    for (int i = 1; i < dims_; ++i) {
      body.low[i] = std::min(body.low[i], scale * at.dot(body.axis[i]));
      body.high[i] = std::max(body.high[i], scale * at.dot(body.axis[i]));
    }
  }
  body.round = !leaf.yaw;
  if (body.round) {  // the tangents' bearing
    const double sine = std::min(prism.half.x() / (level * body.distance), 1.0);
    const double cosine = std::sqrt(1 - sine * sine);
    const double forward = level * level * cosine + u.z() * u.z();
    body.high[1] = body.distance * level * sine / std::max(forward, kBeside);
    body.low[1] = -body.high[1];
  }
  if (body.high[1] <= 0 || (dims_ == 3 && body.high[2] <= 0)) return;
  body.nearest = body.distance - spread(density.pp);
  const Span bins = span(centre, 0.5 * extent.head<2>().norm() + spread(density.pp));
  body.first_bin = bins.first;
  body.bins = bins.count;
  bodies_.push_back(body);
}

Occlusion::Span Occlusion::span(const Eigen::Vector3d& from_eye, double radius) {
  const double flat = from_eye.head<2>().norm();
  if (radius >= flat) return {0, kBins};
  constexpr double kPerRadian = kBins / (2 * kPi);
  const double bearing = std::atan2(from_eye.y(), from_eye.x()) + kPi;
  const double half = std::asin(radius / flat);
  const int first = static_cast<int>(std::floor((bearing - half) * kPerRadian));
  const int last = static_cast<int>(std::floor((bearing + half) * kPerRadian));
  return {(first + kBins) % kBins, std::min(last - first + 1, kBins)};
}

void Occlusion::sort_into_bins() {
  std::sort(bodies_.begin(), bodies_.end(), [](const Body& a, const Body& b) {
    return a.nearest != b.nearest ? a.nearest < b.nearest : a.birth < b.birth;
  });
  begins_.assign(kBins + 1, 0);
  for (const Body& body : bodies_)
    for (int i = 0; i < body.bins; ++i) ++begins_[(body.first_bin + i) % kBins + 1];
  for (int bin = 0; bin < kBins; ++bin) begins_[bin + 1] += begins_[bin];
  in_bin_.resize(begins_.back());
  std::vector<int> next(begins_.begin(), begins_.end() - 1);
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    for (int i = 0; i < bodies_[b].bins; ++i)
      in_bin_[next[(bodies_[b].first_bin + i) % kBins]++] = static_cast<int>(b);
}

double Occlusion::clear(const Gaussian& density, std::uint64_t birth) const {
  if (bodies_.empty()) return 1;
  const Eigen::Vector3d from_eye = density.mean - eye_;
  const double reach = spread(density.covariance), farthest = from_eye.norm() + reach;
  const Span bins = span(from_eye, reach);
  double clear = 1;
  for (int i = 0; i < bins.count; ++i) {
    const int bin = (bins.first + i) % kBins;
    for (int k = begins_[bin]; k < begins_[bin + 1]; ++k) {
      const Body& body = bodies_[in_bin_[k]];
      if (body.nearest > farthest) break;
      if (clear < kHidden) return clear;
      // One that stands in several bins counts in the first.
      if (i > 0 && (bin != body.first_bin || body.in(bins.first))) continue;
      if (body.birth != birth) clear *= 1 - body.p * hides(body, from_eye, density.covariance);
    }
  }
  return clear;
}

/// The probability that the body is there between the eye and the point, and the line meets it.
double Occlusion::hides(const Body& body, const Eigen::Vector3d& from_eye,
                        const Eigen::Matrix3d& covariance) const {
  const double along = from_eye.dot(body.axis[0]);
  if (along <= 0) return 0;
  const auto sigma = [&](int i, double scale) {
    const double variance =
        body.variance[i] + scale * scale * variance_along(body.axis[i], covariance);
    return std::sqrt(std::max(variance, kLeast));
  };
  const double scale = body.distance / along;  // from the point to where the body is
  double p = 1, depth = body.depth;
  for (int i = 1; i < dims_ && p > 0; ++i) {
    const double off = scale * from_eye.dot(body.axis[i]), s = sigma(i, scale);
    p *= normal_between((body.low[i] - off) / s, (body.high[i] - off) / s);
    const double beside = off / body.high[i];
    if (i == 1 && body.round) depth *= std::sqrt(std::max(0.0, 1 - beside * beside));
  }
  p *= 0.5 * std::erfc((body.distance + depth - along) / (sigma(0, 1) * std::numbers::sqrt2));
  return p;
}

}  // namespace anchord
