#include "tests/anchoring/enumerated_density.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <set>

namespace anchord::enumeration {
namespace {

[[noreturn]] void refuse(const char* what) {
  std::fprintf(stderr, "enumeration: %s\n", what);
  std::abort();
}

/// P(N(0, 1) <= x)
double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// P(a <= N(0, 1) <= b), without losing the small differences of the upper tail.
double normal_interval(double a, double b) {
  return a > 0 ? normal_cdf(-a) - normal_cdf(-b) : normal_cdf(b) - normal_cdf(a);
}

/// Nodes and weights of Gauss-Legendre quadrature on [-1, 1].
struct Quadrature {
  static constexpr int kPoints = 16;
  std::array<double, kPoints> node, weight;

  Quadrature() {
    for (int i = 0; i < kPoints; ++i) {
      double x = std::cos(std::numbers::pi * (i + 0.75) / (kPoints + 0.5)), slope = 1;
      for (int step = 0; step < 50; ++step) {  // Newton on the Legendre polynomial
        double p0 = 1, p1 = x;
        for (int n = 2; n <= kPoints; ++n) {
          const double p2 = ((2 * n - 1) * x * p1 - (n - 1) * p0) / n;
          p0 = p1;
          p1 = p2;
        }
        slope = kPoints * (x * p1 - p0) / (x * x - 1);
        x -= p1 / slope;
      }
      node[i] = x;
      weight[i] = 2 / ((1 - x * x) * slope * slope);
    }
  }
};

bool inside(const std::vector<Eigen::Vector2d>& polygon, double x, double y) {
  bool in = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[j];
    if ((a.y() > y) != (b.y() > y) && x < a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      in = !in;
  }
  return in;
}

}  // namespace

std::vector<Rectangle> rectangles(const std::vector<Eigen::Vector2d>& polygon) {
  std::set<double> xs, ys;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a.x() != b.x() && a.y() != b.y()) refuse("a polygon's edge is not along an axis");
    xs.insert(a.x());
    ys.insert(a.y());
  }
  std::vector<Rectangle> result;
  for (auto x = xs.begin(); std::next(x) != xs.end(); ++x) {
    for (auto y = ys.begin(); std::next(y) != ys.end(); ++y) {
      if (inside(polygon, (*x + *std::next(x)) / 2, (*y + *std::next(y)) / 2))
        result.push_back({*x, *y, *std::next(x), *std::next(y)});
    }
  }
  return result;
}

double probability(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance,
                   const Rectangle& rectangle) {
  const double sx = std::sqrt(covariance(0, 0)), sy = std::sqrt(covariance(1, 1));
  const double rho = covariance(0, 1) / (sx * sy);
  const double x0 = (rectangle[0] - mean.x()) / sx, x1 = (rectangle[2] - mean.x()) / sx;
  const double y0 = (rectangle[1] - mean.y()) / sy, y1 = (rectangle[3] - mean.y()) / sy;
  if (covariance(0, 1) == 0) return normal_interval(x0, x1) * normal_interval(y0, y1);

  // Integrate phi(x) P(y0 <= y <= y1 | x); beyond 10 standard deviations lies less than 1e-22.
  // The second factor steps where x rho = y0 or y1, over a width of s / |rho|.
  const double low = std::max(x0, -10.0), high = std::min(x1, 10.0);
  if (low >= high) return 0;
  const double s = std::sqrt((1 - rho) * (1 + rho));
  std::set<double> breaks{low, high};
  for (int k = -10; k <= 10; ++k) {
    for (const double x : {static_cast<double>(k), (y0 + k * s) / rho, (y1 + k * s) / rho})
      if (x > low && x < high) breaks.insert(x);
  }
  static const Quadrature quadrature;
  double sum = 0;
  for (auto a = breaks.begin(); std::next(a) != breaks.end(); ++a) {
    const double middle = (*a + *std::next(a)) / 2, half = (*std::next(a) - *a) / 2;
    for (int i = 0; i < Quadrature::kPoints; ++i) {
      const double x = middle + half * quadrature.node[i];
      sum += half * quadrature.weight[i] * std::exp(-x * x / 2) *
             normal_interval((y0 - rho * x) / s, (y1 - rho * x) / s);
    }
  }
  return sum / std::sqrt(2 * std::numbers::pi);
}

double normal_density(const Eigen::VectorXd& z, const Eigen::VectorXd& mean,
                      const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd error = z - mean;
  const double distance = error.dot(covariance.inverse() * error);
  return std::exp(-distance / 2) / std::sqrt((2 * std::numbers::pi * covariance).determinant());
}

Eigen::MatrixXd exponential(Eigen::MatrixXd a) {
  int squarings = 0;
  for (; a.cwiseAbs().rowwise().sum().maxCoeff() > 0.25; ++squarings) a /= 2;
  Eigen::MatrixXd term = Eigen::MatrixXd::Identity(a.rows(), a.cols()), sum = term;
  for (int n = 1; n <= 20; ++n) {
    term = term * a / n;
    sum += term;
  }
  for (; squarings > 0; --squarings) sum = (sum * sum).eval();
  return sum;
}

Sight Sight::of(const Frame& frame, const Sensor& sensor, int dims) {
  const std::optional<View>& view = frame.view ? frame.view : sensor.view;
  Sight sight;
  sight.viewer = frame.sensor;
  Eigen::Vector2d origin(0, 0);
  if (frame.pose) {
    if (frame.pose->orientation != Pose().orientation) refuse("turned sensors are not enumerated");
    const auto& [x, y, z] = frame.pose->position;
    sight.from.emplace(x, y, dims == 3 ? z : 0);
    origin = {x, y};
  }
  if (!view || view->type == View::Type::kNone) return sight;
  if (view->type == View::Type::kWorld) {
    sight.everything = true;
  } else if (view->type == View::Type::kPolygon) {
    std::vector<Eigen::Vector2d> polygon;
    for (const auto& point : view->points)
      polygon.push_back(origin + Eigen::Vector2d(point[0], point[1]));
    sight.seen = rectangles(polygon);
  } else {
    refuse("sectors and frusta are not enumerated");
  }
  return sight;
}

double Sight::range(const Eigen::VectorXd& point) const {
  return from ? (point - from->head(point.size())).norm() : 0;
}

bool Sight::contains(const Eigen::Vector2d& p) const {
  return everything || std::any_of(seen.begin(), seen.end(), [&](const Rectangle& r) {
           return p.x() > r[0] && p.y() > r[1] && p.x() < r[2] && p.y() < r[3];
         });
}

Cells::Cells(const Knowledge& knowledge)
    : dims(knowledge.dims), origin(knowledge.bounds_min.head<2>()), edge(knowledge.cell) {
  const Eigen::Vector3d size = knowledge.bounds_max - knowledge.bounds_min;
  columns = static_cast<int>(std::lround(size.x() / edge));
  rows = static_cast<int>(std::lround(size.y() / edge));
  if (columns * edge != size.x() || rows * edge != size.y()) refuse("bounds of whole cells only");
  if (dims == 3) {
    floor = knowledge.bounds_min.z();
    ceiling = knowledge.bounds_max.z();
  }
}

int Cells::find(const Eigen::VectorXd& point) const {
  const double x = std::floor((point(0) - origin.x()) / edge);
  const double y = std::floor((point(1) - origin.y()) / edge);
  if (x < 0 || y < 0 || x >= columns || y >= rows) return -1;
  return static_cast<int>(y) * columns + static_cast<int>(x);
}

Eigen::Vector2d Cells::centre(int cell) const {
  return origin + edge * Eigen::Vector2d(cell % columns + 0.5, cell / columns + 0.5);
}

double Cells::range(int cell, double low, double high, const Sight& sight) const {
  if (!sight.from) return 0;
  const Eigen::Vector2d at = centre(cell);
  if (dims == 2) return sight.range(at);
  return sight.range(Eigen::Vector3d(at.x(), at.y(), std::clamp(sight.from->z(), low, high)));
}

Extent extent(const Knowledge& knowledge, const Cells& cells, int place) {
  Extent result{Eigen::VectorXd::Ones(cells.count()), cells.floor, cells.ceiling};
  if (place >= 0) {
    const Region& region = knowledge.places[place].region;
    const Sight inside_of{false, rectangles(region.polygon)};
    double area = 0;
    for (const Rectangle& r : inside_of.seen) area += (r[2] - r[0]) * (r[3] - r[1]);
    for (int i = 0; i < cells.count(); ++i)
      result.uniform(i) = inside_of.contains(cells.centre(i)) ? 1 : 0;
    if (std::abs(area - result.uniform.sum() * cells.edge * cells.edge) > 1e-9)
      refuse("places of whole cells only");
    if (cells.dims == 3) {
      result.floor = std::max(cells.floor, region.z_min);
      result.ceiling = std::min(cells.ceiling, region.z_max);
    }
  }
  result.uniform /= result.uniform.sum();
  return result;
}

Moments merge(double weight_a, const Moments& a, double weight_b, const Moments& b) {
  if (weight_a == 0) return b;
  if (weight_b == 0) return a;
  const double share = weight_a / (weight_a + weight_b);
  const Eigen::VectorXd mean = share * a.mean + (1 - share) * b.mean;
  const auto about_mean = [&](const Moments& m) -> Eigen::MatrixXd {
    return m.covariance + (m.mean - mean) * (m.mean - mean).transpose();
  };
  return {mean, share * about_mean(a) + (1 - share) * about_mean(b)};
}

Moments alone(const Moments& state, const BehaviourModel& model, int dims) {
  if (!model.shares()) return state;
  Eigen::MatrixXd sum(dims, 2 * dims);
  sum << Eigen::MatrixXd::Identity(dims, dims), Eigen::MatrixXd::Identity(dims, dims);
  return {sum * state.mean, sum * state.covariance * sum.transpose()};
}

Moments fit(const Moments& state, const BehaviourModel& model, int dims) {
  if (model.shares()) {
    Moments result{Eigen::VectorXd::Zero(2 * dims), Eigen::MatrixXd::Zero(2 * dims, 2 * dims)};
    result.mean.head(dims) = state.mean.head(dims);
    const Eigen::MatrixXd apart = model.reach * model.reach * Eigen::MatrixXd::Identity(dims, dims);
    result.covariance << state.covariance.topLeftCorner(dims, dims) + apart, -apart, -apart, apart;
    return result;
  }
  if (model.kind == BehaviourModel::Kind::kConstantPosition)
    return {state.mean.head(dims), state.covariance.topLeftCorner(dims, dims)};
  if (state.mean.size() == 2 * dims) return state;
  Moments result{Eigen::VectorXd::Zero(2 * dims), Eigen::MatrixXd::Zero(2 * dims, 2 * dims)};
  result.mean.head(dims) = state.mean;
  result.covariance.topLeftCorner(dims, dims) = state.covariance;
  for (int i = 0; i < dims; ++i)
    result.covariance(dims + i, dims + i) = model.initial_velocity_variance[i];
  return result;
}

Moments moments(const Eigen::VectorXd& probabilities, const Cells& cells, const Extent& extent) {
  const int d = cells.dims;
  Moments total{Eigen::VectorXd::Zero(d), Eigen::MatrixXd::Zero(d, d)};
  const double height = extent.ceiling - extent.floor;
  for (int i = 0; i < cells.count(); ++i) {
    Eigen::VectorXd centre = Eigen::VectorXd::Constant(d, (extent.floor + extent.ceiling) / 2);
    centre(0) = cells.centre(i).x();
    centre(1) = cells.centre(i).y();
    total.mean += probabilities(i) * centre;
    total.covariance += probabilities(i) * centre * centre.transpose();
  }
  total.covariance -= total.mean * total.mean.transpose();
  total.covariance.diagonal().array() += cells.edge * cells.edge / 12;  // flat inside a cell
  if (d == 3) total.covariance(2, 2) += (height * height - cells.edge * cells.edge) / 12;
  return total;
}

}  // namespace anchord::enumeration
