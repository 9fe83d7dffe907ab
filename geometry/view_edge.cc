// How the mass in view changes with the density's mean: by the divergence theorem an integral over
// the view's edge, closed in the plane and along rays, by Gauss-Legendre quadrature across them.

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/standard_normal.h"
#include "geometry/sweep.h"
#include "geometry/view.h"

namespace anchord {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

const double kRootTwoPi = std::sqrt(2 * std::numbers::pi);
constexpr double kFar = Sweep::kFar;

/// A density in the sensor's frame, and what was integrated over the edge so far: N dS and
/// (x - mean) N dS', dS pointing outward.
template <int D>
class Edge {
 public:
  using Vector = Eigen::Matrix<double, D, 1>;
  using Matrix = Eigen::Matrix<double, D, D>;

  Edge(const Vector& mean_at, const Matrix& covariance_there, double nearest, double farthest)
      : mean(mean_at),
        covariance(covariance_there),
        near(nearest),
        far(farthest),
        whiten_(upper_factor<D>(covariance).inverse()),
        white_(whiten_ * mean),
        scale_(whiten_.determinant() / std::pow(kRootTwoPi, D)) {}

  const Vector mean;
  const Matrix covariance;
  const double near, far;  ///< range limits, m

  Matrix information() const { return whiten_.transpose() * whiten_; }
  bool beyond(const Vector& normal) const {
    return std::abs(normal.dot(mean)) > kFar * std::sqrt(normal.dot(covariance * normal));
  }

  /// ln of the highest density along the view's part of a ray, over the density's peak.
  double log_along(const Vector& u) const {
    const Ray ray(*this, u);
    const double off = std::clamp(ray.peak, ray.from, ray.to) - ray.peak;
    return -0.5 * (ray.aside2 + off * off);
  }
  /// Adds a strip along the ray of the unit vector u: dS = s^(D-2) area ds.
  void add_ray(const Vector& u, const Vector& area) {
    const Ray ray(*this, u);
    const double a = ray.from - ray.peak, b = ray.to - ray.peak;
    const double start = std::exp(-a * a / 2), end = std::exp(-b * b / 2);
    // Of t^n exp(-(t - peak)^2 / 2), t being s in standard deviations along the ray.
    double zeroth = kRootTwoPi * normal_between(a, b);
    double first = start - end + ray.peak * zeroth;
    if constexpr (D == 3) {
      const double second = ray.from * start - ray.to * end + ray.peak * first + zeroth;
      zeroth = first * ray.sigma;
      first = second * ray.sigma;
    }
    const double n = scale_ * std::exp(-ray.aside2 / 2) * ray.sigma;
    add((n * first * ray.sigma) * u - (n * zeroth) * mean, n * zeroth, area);
  }
  /// The same of a half-plane of that bearing.
  double log_beside(const Vector2d& u) const {
    const Vector normal(u.y(), -u.x(), 0);
    const double off = normal.dot(mean);
    return -0.5 * off * off / normal.dot(covariance * normal);
  }
  double log_at(const Vector& x) const { return -0.5 * (whiten_ * x - white_).squaredNorm(); }
  void add_point(const Vector& x, const Vector& area) {
    const double n = scale_ * std::exp(log_at(x));
    add(n * (x - mean), n, area);
  }

  Vector gradient() const { return -flux_; }
  Matrix hessian() const {
    const Matrix h = -information() * moment_;
    return 0.5 * (h + h.transpose());
  }

 private:
  /// Along s u the density is proportional to exp(-(s / sigma - peak)^2 / 2 - aside2 / 2).
  struct Ray {
    double sigma, peak, aside2, from, to;
    Ray(const Edge& edge, const Vector& u) {
      const Vector w = edge.whiten_ * u;
      sigma = 1 / w.norm();
      peak = w.dot(edge.white_) * sigma;
      aside2 = std::max(edge.white_.squaredNorm() - peak * peak, 0.0);
      from = edge.near / sigma;
      to = edge.far / sigma;
    }
  };
  void add(const Vector& first, double n, const Vector& area) {
    flux_ += n * area;
    moment_ += first * area.transpose();
  }

  Matrix whiten_;
  Vector white_;
  double scale_;
  Vector flux_ = Vector::Zero();
  Matrix moment_ = Matrix::Zero();
};

/// Of a wedge without end, in the plane of two axes: its first angle and its width.
void cut_by_angles(const Vector3d& mean, const Matrix3d& covariance, const std::array<int, 2>& axes,
                   const std::array<double, 2>& wedge, MassDerivatives& out) {
  Edge<2> edge(mean(axes), covariance(axes, axes), 0, std::numeric_limits<double>::infinity());
  for (const double side : {0.0, 1.0}) {
    const double angle = wedge[0] + side * wedge[1];
    const Vector2d u(std::cos(angle), std::sin(angle));
    edge.add_ray(u, (side == 0 ? 1 : -1) * Vector2d(u.y(), -u.x()));
  }
  out.gradient(axes) = edge.gradient();
  out.hessian(axes, axes) = edge.hessian();
}

}  // namespace

MassDerivatives MapView::mass_derivatives(const Gaussian& density) const {
  if (sees_everything() || sees_nothing()) return {};
  if (type_ == View::Type::kPolygon) return polygon_derivatives(density);
  const Vector3d mean = in_sensor(density.mean);
  const Depth at_mean = depth(mean);
  const auto& c = density.covariance;
  const double sphere = kFar * std::sqrt(c(0, 0) + c(1, 1) + (dims_ == 3 ? c(2, 2) : 0));
  if (std::abs(at_mean.least()) >= sphere) return {};
  const Matrix3d covariance = rotation_.transpose() * c * rotation_;
  const Clearance clear = clearance(mean, covariance, at_mean, sphere, MassPrecision(0));
  if (clear.outside) return {};
  MassDerivatives there;
  if (clear.range && clear.elevation) {
    cut_by_angles(mean, covariance, {0, 1}, {bearing_from_, bearing_width_}, there);
  } else if (clear.range && clear.bearing && type_ == View::Type::kFrustum) {
    cut_by_angles(mean, covariance, {0, 2}, {elevation_min_, elevation_max_ - elevation_min_},
                  there);
  } else if (dims_ == 2) {
    flat_derivatives(mean, covariance, clear, there);
  } else {
    solid_derivatives(mean, covariance, clear, there);
  }
  return {rotation_ * there.gradient, rotation_ * there.hessian * rotation_.transpose()};
}

/// The sum over a polygon's edges; nothing depends on height.
MassDerivatives MapView::polygon_derivatives(const Gaussian& density) const {
  const Matrix2d factor = upper_factor<2>(density.covariance.topLeftCorner<2, 2>());
  const Vector2d mean = density.mean.head<2>();
  Vector2d flux = Vector2d::Zero();
  Matrix2d moment = Matrix2d::Zero();
  double area = 0;
  Vector2d from = solve_upper(factor, polygon_.polygon.back() - mean);
  for (const auto& point : polygon_.polygon) {
    const Vector2d to = solve_upper(factor, point - mean), edge = to - from;
    area += from.x() * to.y() - from.y() * to.x();
    const double length = edge.norm();
    if (length > 0) {
      const Vector2d along = edge / length, outward(along.y(), -along.x());
      const double h = outward.dot(from), a = along.dot(from), b = along.dot(to);
      if (std::abs(h) < kFar && a < kFar && b > -kFar) {
        const double bell = std::exp(-h * h / 2) / kRootTwoPi, part = normal_between(a, b);
        const double skew = (std::exp(-a * a / 2) - std::exp(-b * b / 2)) / kRootTwoPi;
        flux += bell * part * outward;
        moment += bell * (h * part * outward + skew * along) * outward.transpose();
      }
    }
    from = to;
  }
  const Matrix2d whiten = factor.inverse(), inward = (area > 0 ? -1 : 1) * whiten;  // or clockwise
  const Matrix2d hessian = whiten.transpose() * moment * inward;
  MassDerivatives out;
  out.gradient.head<2>() = inward.transpose() * flux;
  out.hessian.topLeftCorner<2, 2>() = 0.5 * (hessian + hessian.transpose());
  return out;
}

/// Two rays and two arcs.
void MapView::flat_derivatives(const Vector3d& mean, const Matrix3d& covariance,
                               const Clearance& clear, MassDerivatives& out) const {
  Edge<2> edge(mean.head<2>(), covariance.topLeftCorner<2, 2>(), range_min_, range_max_);
  for (int i = 0; i < 2 && !clear.bearing; ++i) {
    const double bearing = bearing_from_ + i * bearing_width_;
    const Vector2d normal = bearing_normal_[i].head<2>();
    if (!edge.beyond(normal)) edge.add_ray({std::cos(bearing), std::sin(bearing)}, -normal);
  }
  const Sweep sweep(edge.mean, edge.covariance);
  const auto arc = [&](double range, double outward) {
    sweep(
        bearing_from_, bearing_from_ + bearing_width_, Sweep::kCurve,
        [&](const Vector2d& u) { return edge.log_at(range * u); },
        [&](const Vector2d& u, double angle) {
          edge.add_point(range * u, (outward * angle * range) * u);
        });
  };
  if (!clear.range) {
    arc(range_max_, 1);
    if (range_min_ > 0) arc(range_min_, -1);
  }
  out.gradient.head<2>() = edge.gradient();
  out.hessian.topLeftCorner<2, 2>() = edge.hessian();
}

/// Two half-planes at the bearings' limits, two planes or cones at the elevations', two spheres.
void MapView::solid_derivatives(const Vector3d& mean, const Matrix3d& covariance,
                                const Clearance& clear, MassDerivatives& out) const {
  Edge<3> edge(mean, covariance, range_min_, range_max_);
  const bool planes = type_ == View::Type::kFrustum;
  const Matrix3d information = edge.information();
  const Vector3d towards = information * mean;
  const double first = bearing_from_, last = bearing_from_ + bearing_width_;
  const Sweep bearings(mean.head<2>(), covariance.topLeftCorner<2, 2>());
  // The elevations in view at a bearing.
  const auto elevations = [&](const Vector2d& forward, double widest, const auto& log_weight,
                              const auto& use) {
    Eigen::Matrix<double, 3, 2> basis;
    basis << forward.x(), 0, forward.y(), 0, 0, 1;
    const Matrix2d there = (basis.transpose() * information * basis).inverse();
    const auto at = [&](const Vector2d& u) {
      return Vector3d(u.x() * forward.x(), u.x() * forward.y(), u.y());
    };
    const auto limit = [&](double e) { return planes ? std::atan(std::tan(e) * forward.x()) : e; };
    Sweep(there * (basis.transpose() * towards), there)(
        limit(elevation_min_), limit(elevation_max_), widest,
        [&](const Vector2d& u) { return log_weight(at(u)); },
        [&](const Vector2d& u, double angle) { use(at(u), angle); });
  };
  for (int i = 0; i < 2 && !clear.bearing; ++i) {
    const Vector3d& normal = bearing_normal_[i];
    if (edge.beyond(normal)) continue;
    const double bearing = i == 0 ? first : last;
    elevations(
        {std::cos(bearing), std::sin(bearing)}, Sweep::kRays,
        [&](const Vector3d& u) { return edge.log_along(u); },
        [&](const Vector3d& u, double angle) { edge.add_ray(u, -angle * normal); });
  }
  const auto slope = [&](double elevation, const Vector2d& inward, double outward) {
    const double off = inward.dot(Vector2d(along(mean), mean.z()));
    if (std::abs(off) > kFar * std::sqrt(covariance.trace())) return;
    const double level = planes ? 1 : std::cos(elevation);
    const double up = planes ? std::tan(elevation) : std::sin(elevation);
    const auto ray = [&](const Vector2d& u) {
      return Vector3d(level * u.x(), level * u.y(), planes ? up * u.x() : up);
    };
    bearings(
        first, last, planes ? Sweep::kRays : Sweep::kCurve,
        [&](const Vector2d& u) { return edge.log_along(ray(u).normalized()); },
        [&](const Vector2d& u, double angle) {
          const Vector3d along = ray(u);
          const Vector3d change(-level * u.y(), level * u.x(), planes ? -up * u.y() : 0);
          const double length2 = along.squaredNorm();
          edge.add_ray(along / std::sqrt(length2),
                       (outward * angle / length2) * along.cross(change));
        });
  };
  if (!clear.elevation && has_floor_) slope(elevation_min_, floor_normal_, -1);
  if (!clear.elevation && has_ceiling_) slope(elevation_max_, ceiling_normal_, 1);
  const auto cap = [&](double range, double outward) {
    bearings(
        first, last, Sweep::kCurve, [&](const Vector2d& u) { return edge.log_beside(u); },
        [&](const Vector2d& forward, double bearing) {
          elevations(
              forward, Sweep::kCurve, [&](const Vector3d& u) { return edge.log_at(range * u); },
              [&](const Vector3d& u, double elevation) {
                const double area = range * range * bearing * elevation * u.head<2>().norm();
                edge.add_point(range * u, outward * area * u);
              });
        });
  };
  if (!clear.range) {
    cap(range_max_, 1);
    if (range_min_ > 0) cap(range_min_, -1);
  }
  out.gradient = edge.gradient();
  out.hessian = edge.hessian();
}

}  // namespace anchord
