#include "models/kinematic.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <numbers>

namespace anchord {
namespace {

template <int D>
using Square = Eigen::Matrix<double, D, D>;

template <int D>
Eigen::LLT<Square<D>> innovation(const Kinematic& state, const Gaussian& z) {
  return Eigen::LLT<Square<D>>(state.pp.topLeftCorner<D, D>() +
                               z.covariance.topLeftCorner<D, D>());
}

template <int D>
Fit fit_in(const Kinematic& state, const Gaussian& z) {
  const auto llt = innovation<D>(state, z);
  Eigen::Matrix<double, D, 1> e = z.mean.head<D>() - state.position.head<D>();
  llt.matrixL().solveInPlace(e);
  const double distance2 = e.squaredNorm();
  const double log_root_det = llt.matrixLLT().diagonal().array().log().sum();
  return {-0.5 * distance2 - log_root_det - 0.5 * D * std::log(2 * std::numbers::pi), distance2};
}

template <int D>
void update_in(Kinematic& state, const Gaussian& z) {
  const auto llt = innovation<D>(state, z);
  const Square<D> p = state.pp.topLeftCorner<D, D>(), c = state.pv.topLeftCorner<D, D>();
  const Square<D> r = z.covariance.topLeftCorner<D, D>();
  const Square<D> gain = llt.solve(p).transpose();           // P S^-1
  const Square<D> gain_velocity = llt.solve(c).transpose();  // C' S^-1
  const Eigen::Matrix<double, D, 1> e = z.mean.head<D>() - state.position.head<D>();
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

Kinematic kinematic_at(const Gaussian& measurement, double velocity_variance, int dims) {
  Kinematic state;
  state.position = measurement.mean;
  state.pp = measurement.covariance;
  for (int i = 0; i < dims; ++i) state.vv(i, i) = velocity_variance;
  return state;
}

void predict_constant_position(Kinematic& state, double psd, double dt, int dims) {
  for (int i = 0; i < dims; ++i) state.pp(i, i) += psd * dt;
}

void predict_constant_velocity(Kinematic& state, double psd, double dt, int dims) {
  state.position += dt * state.velocity;
  state.pp += dt * (state.pv + state.pv.transpose()) + dt * dt * state.vv;
  state.pv += dt * state.vv;
  for (int i = 0; i < dims; ++i) {
    state.pp(i, i) += psd * dt * dt * dt / 3;
    state.pv(i, i) += psd * dt * dt / 2;
    state.vv(i, i) += psd * dt;
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
