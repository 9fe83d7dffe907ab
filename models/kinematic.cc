#include "models/kinematic.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace anchord {
namespace {

template <int D>
using Square = Eigen::Matrix<double, D, D>;

template <int D>
using Vector = Eigen::Matrix<double, D, 1>;

/// The Cholesky factor of an innovation's covariance S = pp + R, unrolled: this is the innermost
/// loop of all association.
template <int D>
struct Innovation {
  double l[D][D];

  Innovation(const Kinematic& state, const Gaussian& z) {
    for (int i = 0; i < D; ++i)
      for (int j = 0; j <= i; ++j) {
        double s = state.pp(i, j) + z.covariance(i, j);
        for (int k = 0; k < j; ++k) s -= l[i][k] * l[j][k];
        l[i][j] = i == j ? std::sqrt(s) : s / l[j][j];
      }
  }
  /// L^-1 x.
  Vector<D> whiten(const Vector<D>& x) const {
    Vector<D> y;
    for (int i = 0; i < D; ++i) {
      double s = x[i];
      for (int k = 0; k < i; ++k) s -= l[i][k] * y[k];
      y[i] = s / l[i][i];
    }
    return y;
  }
  /// S^-1 m.
  Square<D> solve(const Square<D>& m) const {
    Square<D> out;
    for (int c = 0; c < D; ++c) {
      Vector<D> y = whiten(m.col(c));
      for (int i = D - 1; i >= 0; --i) {
        for (int k = i + 1; k < D; ++k) y[i] -= l[k][i] * y[k];
        y[i] /= l[i][i];
      }
      out.col(c) = y;
    }
    return out;
  }
  double root_determinant() const {
    double product = 1;
    for (int i = 0; i < D; ++i) product *= l[i][i];
    return product;
  }
};

template <int D>
Fit fit_in(const Kinematic& state, const Gaussian& z) {
  const Innovation<D> innovation(state, z);
  const Vector<D> e = z.mean.head<D>() - state.position.head<D>();
  const double distance2 = innovation.whiten(e).squaredNorm();
  return {-0.5 * distance2 - std::log(innovation.root_determinant()) -
              0.5 * D * std::log(2 * std::numbers::pi),
          distance2};
}

template <int D>
void update_in(Kinematic& state, const Gaussian& z) {
  const Innovation<D> innovation(state, z);
  const Square<D> p = state.pp.topLeftCorner<D, D>(), c = state.pv.topLeftCorner<D, D>();
  const Square<D> r = z.covariance.topLeftCorner<D, D>();
  const Square<D> gain = innovation.solve(p).transpose();           // P S^-1
  const Square<D> gain_velocity = innovation.solve(c).transpose();  // C' S^-1
  const Vector<D> e = z.mean.head<D>() - state.position.head<D>();
  state.position.head<D>() += gain * e;
  state.velocity.head<D>() += gain_velocity * e;
  const Square<D> rest = Square<D>::Identity() - gain;
  Square<D> pp = rest * p * rest.transpose() + gain * r * gain.transpose();
  Square<D> vv = state.vv.topLeftCorner<D, D>() - gain_velocity * c;
  state.pp.topLeftCorner<D, D>() = 0.5 * (pp + pp.transpose());
  state.pv.topLeftCorner<D, D>() = rest * c;
  state.vv.topLeftCorner<D, D>() = 0.5 * (vv + vv.transpose());
}

template <int D>
void keep_above_in(Kinematic& state, double floor) {
  Eigen::SelfAdjointEigenSolver<Square<D>> solver;
  solver.computeDirect(state.pp.topLeftCorner<D, D>());
  if (solver.eigenvalues().minCoeff() >= floor) return;
  const auto raised = solver.eigenvalues().cwiseMax(floor).asDiagonal();
  state.pp.topLeftCorner<D, D>() =
      solver.eigenvectors() * raised * solver.eigenvectors().transpose();
}

}  // namespace

Kinematic kinematic_at(const Gaussian& measurement, const ByAxis& velocity_variance, int dims) {
  Kinematic state;
  state.position = measurement.mean;
  state.pp = measurement.covariance;
  for (int i = 0; i < dims; ++i) state.vv(i, i) = velocity_variance[i];
  return state;
}

void predict_constant_position(Kinematic& state, const ByAxis& psd, double dt, int dims) {
  for (int i = 0; i < dims; ++i) state.pp(i, i) += psd[i] * dt;
}

void predict_constant_velocity(Kinematic& state, const ByAxis& psd, double dt, int dims) {
  state.position += dt * state.velocity;
  state.pp += dt * (state.pv + state.pv.transpose()) + dt * dt * state.vv;
  state.pv += dt * state.vv;
  for (int i = 0; i < dims; ++i) {
    state.pp(i, i) += psd[i] * dt * dt * dt / 3;
    state.pv(i, i) += psd[i] * dt * dt / 2;
    state.vv(i, i) += psd[i] * dt;
  }
}

Fit fit(const Kinematic& state, const Gaussian& measurement, int dims) {
  return dims == 2 ? fit_in<2>(state, measurement) : fit_in<3>(state, measurement);
}

void update(Kinematic& state, const Gaussian& measurement, int dims) {
  dims == 2 ? update_in<2>(state, measurement) : update_in<3>(state, measurement);
}

Kinematic merge(double weight_a, const Kinematic& a, double weight_b, const Kinematic& b) {
  const double u = weight_a / (weight_a + weight_b), v = 1 - u;
  const Eigen::Vector3d dp = b.position - a.position, dv = b.velocity - a.velocity;
  Kinematic m;
  m.position = a.position + v * dp;
  m.velocity = a.velocity + v * dv;
  m.pp = u * a.pp + v * b.pp + u * v * dp * dp.transpose();
  m.pv = u * a.pv + v * b.pv + u * v * dp * dv.transpose();
  m.vv = u * a.vv + v * b.vv + u * v * dv * dv.transpose();
  return m;
}

void keep_above(Kinematic& state, double floor, int dims) {
  if (floor <= 0) return;
  dims == 2 ? keep_above_in<2>(state, floor) : keep_above_in<3>(state, floor);
}

}  // namespace anchord
