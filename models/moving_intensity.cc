#include "models/moving_intensity.h"

#include <Eigen/LU>
#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "geometry/gaussian_mass.h"

namespace anchord {
namespace {

using Component = MovingIntensity::Component;
using Mixture = MovingIntensity::Mixture;
using Source = MovingArrivals::Source;

/// Two components are as good as one where merging them costs at most this, see cost(): the
/// density's relative entropy to what stands for it is no more, in nats.
constexpr double kAlike = 0.01;
/// Components per source. At kAlike a source that is never looked at has about ten.
constexpr std::size_t kMost = 32;
/// An expected number that is not worth a component of its own.
constexpr double kLeast = 1e-9;

double log_volume(const Kinematic& density, int dims) {
  return 0.5 * std::log(density.pp.topLeftCorner(dims, dims).determinant());
}

Component merged(const Component& a, const Component& b) {
  return {a.weight + b.weight, merge(a.weight, a.density, b.weight, b.density)};
}

/// What is lost by merging two components, per expected object: Runnalls' bound (2007, IEEE TAES
/// 43(3), equation 16) for their densities over position.
double cost(const Component& a, const Component& b, int dims) {
  const Component both = merged(a, b);
  return log_volume(both.density, dims) -
         (a.weight * log_volume(a.density, dims) + b.weight * log_volume(b.density, dims)) /
             both.weight;
}

void reduce(Mixture& mixture, int dims) {
  std::erase_if(mixture, [](const Component& c) { return c.weight <= 0; });
  const auto worth = [&](std::size_t i) {
    const Component &a = mixture[i], &b = mixture[i + 1];
    return std::min(a.weight, b.weight) < kLeast ? 0.0 : cost(a, b, dims);
  };
  while (mixture.size() > 1) {
    std::size_t cheapest = 0;
    double least = worth(0);
    for (std::size_t i = 1; i + 1 < mixture.size() && least > 0; ++i)
      if (const double c = worth(i); c < least) cheapest = i, least = c;
    if (least > kAlike && mixture.size() <= kMost) return;
    mixture[cheapest] = merged(mixture[cheapest], mixture[cheapest + 1]);
    mixture.erase(mixture.begin() + static_cast<std::ptrdiff_t>(cheapest) + 1);
  }
}

void move(Component& c, double dt, const MovingArrivals& arrivals) {
  c.weight *= std::exp(-arrivals.departure_rate * dt);
  if (arrivals.constant_velocity)
    predict_constant_velocity(c.density, arrivals.psd, dt, arrivals.dims);
  else
    predict_constant_position(c.density, arrivals.psd, dt, arrivals.dims);
}

/// What arrived between `age` + `span` and `age` seconds ago and has not left since, by the moments
/// of its density: arrivals are uniform in time, and so the time since then has a density
/// proportional to exp(-mu s).
Component arrived(const Source& source, double age, double span, const MovingArrivals& arrivals) {
  const double x = arrivals.departure_rate * span;
  double integral[4];  // of u^k exp(-x u) over u in [0, 1]
  for (int k = 0; k < 4; ++k)
    integral[k] =
        x < 1e-12 ? 1.0 / (k + 1) : boost::math::tgamma_lower(k + 1.0, x) / std::pow(x, k + 1);
  double s[4];  // the moments of that time
  for (int k = 0; k < 4; ++k) s[k] = std::pow(span, k) * integral[k] / integral[0];

  Component c{source.rate * span * integral[0], source.density};
  Kinematic& d = c.density;
  if (arrivals.constant_velocity) {
    const Eigen::Vector3d v = d.velocity;
    d.position += s[1] * v;
    d.pp +=
        s[1] * (d.pv + d.pv.transpose()) + s[2] * d.vv + (s[2] - s[1] * s[1]) * v * v.transpose();
    d.pv += s[1] * d.vv;
    for (int i = 0; i < arrivals.dims; ++i) {
      d.pp(i, i) += arrivals.psd[i] * s[3] / 3;
      d.pv(i, i) += arrivals.psd[i] * s[2] / 2;
      d.vv(i, i) += arrivals.psd[i] * s[1];
    }
  } else {
    predict_constant_position(d, arrivals.psd, s[1], arrivals.dims);
  }
  move(c, age, arrivals);
  return c;
}

/// All that arrived in the last `span` seconds: in slices as long as one density may stand for.
Mixture arrived(const Source& source, double span, const MovingArrivals& arrivals) {
  struct Slice {
    double age, span, cost;
  };
  const auto slice = [&](double age, double length) {
    const double half = length / 2;
    return Slice{age, length,
                 cost(arrived(source, age + half, half, arrivals),
                      arrived(source, age, half, arrivals), arrivals.dims)};
  };
  std::vector<Slice> slices{slice(0, span)};
  while (slices.size() < kMost) {
    const auto worst = std::max_element(slices.begin(), slices.end(),
                                        [](auto& a, auto& b) { return a.cost < b.cost; });
    if (!(worst->cost > kAlike)) break;
    const double age = worst->age, half = worst->span / 2;
    *worst = slice(age + half, half);
    slices.insert(worst + 1, slice(age, half));
  }
  Mixture out;
  for (const Slice& s : slices) out.push_back(arrived(source, s.age, s.span, arrivals));
  return out;
}

}  // namespace

MovingIntensity::MovingIntensity(std::shared_ptr<const MovingArrivals> arrivals, double since)
    : arrivals_(std::move(arrivals)), time_(since) {
  auto start = std::make_shared<std::vector<Mixture>>();
  for (const Source& source : arrivals_->sources) {
    start->emplace_back();
    if (source.at_start > 0) start->back().push_back({source.at_start, source.density});
  }
  mixtures_ = std::move(start);
}

MovingIntensity MovingIntensity::continued(std::shared_ptr<const MovingArrivals> arrivals,
                                           double time) const {
  MovingIntensity out(std::move(arrivals), time);
  if (*arrivals_ == *out.arrivals_) {
    out.time_ = time_;
    out.mixtures_ = mixtures_;
    return out;
  }
  MovingIntensity now = *this;
  now.advance(time);
  auto mixtures = std::make_shared<std::vector<Mixture>>(*out.mixtures_);
  const std::size_t sources = mixtures->size();
  for (std::size_t s = 0; s < now.mixtures_->size() && sources > 0; ++s) {
    Mixture& into = (*mixtures)[std::min(s, sources - 1)];
    if (s < sources) into.clear();
    for (Component c : (*now.mixtures_)[s]) {
      if (!out.arrivals_->constant_velocity) {
        c.density.velocity.setZero();
        c.density.pv.setZero();
        c.density.vv.setZero();
      } else if (c.density.vv.isZero(0)) {
        c.density.vv = out.arrivals_->sources[std::min(s, sources - 1)].density.vv;
      }
      into.push_back(c);
    }
  }
  for (Mixture& mixture : *mixtures) reduce(mixture, out.arrivals_->dims);
  out.mixtures_ = std::move(mixtures);
  return out;
}

void MovingIntensity::advance(double time) {
  const double dt = time - time_;
  if (dt == 0 || mixtures_->empty()) return;
  auto next = std::make_shared<std::vector<Mixture>>(*mixtures_);
  for (std::size_t s = 0; s < next->size(); ++s) {
    Mixture& mixture = (*next)[s];
    for (Component& c : mixture) move(c, dt, *arrivals_);
    if (const Source& source = arrivals_->sources[s]; source.rate > 0) {
      const Mixture fresh = arrived(source, dt, *arrivals_);
      mixture.insert(mixture.end(), fresh.begin(), fresh.end());
    }
    reduce(mixture, arrivals_->dims);
  }
  time_ = time;
  mixtures_ = std::move(next);
}

double MovingIntensity::miss(const MapView& view,
                             const std::function<double(const Eigen::Vector3d&)>& p) {
  if (mixtures_->empty() || view.sees_nothing()) return 0;
  double expected = 0;
  auto next = std::make_shared<std::vector<Mixture>>(*mixtures_);
  for (Mixture& mixture : *next)
    for (Component& c : mixture) {
      const double q = p(c.density.position) * view.mass(c.density.position_density());
      expected += c.weight * q;
      c.weight *= 1 - q;
    }
  mixtures_ = std::move(next);
  return expected;
}

double MovingIntensity::intensity(const Gaussian& z) const {
  double sum = 0;
  for (const Mixture& mixture : *mixtures_)
    for (const Component& c : mixture)
      sum += c.weight * std::exp(fit(c.density, z, arrivals_->dims).log_likelihood);
  return sum;
}

Kinematic MovingIntensity::found_at(const Gaussian& z, double still_weight,
                                    const Kinematic& still) const {
  Component sum{still_weight, still};
  for (const Mixture& mixture : *mixtures_)
    for (const Component& c : mixture) {
      const Fit f = fit(c.density, z, arrivals_->dims);
      Component found{c.weight * std::exp(f.log_likelihood), c.density};
      if (found.weight <= 0) continue;
      update(found.density, z, arrivals_->dims);
      sum = sum.weight > 0 ? merged(sum, found) : found;
    }
  return sum.density;
}

double MovingIntensity::expected(const Region& region) const {
  double sum = 0;
  for (const Mixture& mixture : *mixtures_)
    for (const Component& c : mixture)
      sum += c.weight * mass(c.density.position_density(), region, arrivals_->dims);
  return sum;
}

}  // namespace anchord
