#include "maintenance/entropy.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace anchord {
namespace {

double plogp(double p) { return p > 0 ? p * std::log(p) : 0; }

/// The bound of position_entropy(), over components that come one by one.
class MixtureBound {
 public:
  explicit MixtureBound(int dims) : dims_(dims) {}

  void add(double weight, const ModelState& model) {
    if (weight <= 0) return;
    Gaussian g;
    double h;
    if (const auto* kinematic = std::get_if<Kinematic>(&model.density)) {
      g = kinematic->position_density();
      h = gaussian_entropy(g.covariance, dims_);
    } else {
      const auto& somewhere = std::get<Somewhere>(model.density);
      g = somewhere.moments();
      h = somewhere.entropy();
    }
    if (count_++ == 0) about_ = g.mean;  // positions may be far from the origin
    const Eigen::Vector3d d = g.mean - about_;
    weight_ += weight;
    mean_ += weight * d;
    second_ += weight * (g.covariance + d * d.transpose());
    labelled_ += weight * h - plogp(weight);
  }

  double value() const {
    if (count_ == 0) return 0;
    const double labelled = labelled_ / weight_ + std::log(weight_);
    if (count_ == 1) return labelled;
    const Eigen::Vector3d mean = mean_ / weight_;
    const Eigen::Matrix3d covariance = second_ / weight_ - mean * mean.transpose();
    return std::min(labelled, gaussian_entropy(covariance, dims_));
  }

 private:
  int dims_, count_ = 0;
  double weight_ = 0, labelled_ = 0;
  Eigen::Vector3d about_ = Eigen::Vector3d::Zero(), mean_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second_ = Eigen::Matrix3d::Zero();
};

double entropy_of(const AttributeBelief& belief) {
  return belief.symbols.empty()
             ? 0.5 * std::log(2 * std::numbers::pi * std::numbers::e * belief.variance)
             : discrete_entropy(belief.symbols);
}

}  // namespace

double discrete_entropy(std::span<const double> probabilities) {
  double sum = 0;
  for (const double p : probabilities) sum -= plogp(p);
  return sum;
}

double binary_entropy(double p) { return -plogp(p) - plogp(1 - p); }

double gaussian_entropy(const Eigen::Matrix3d& covariance, int dims) {
  const double determinant =
      dims == 2 ? covariance.topLeftCorner<2, 2>().determinant() : covariance.determinant();
  if (!(determinant > 0)) return -std::numeric_limits<double>::infinity();
  return 0.5 * (dims * (1 + std::log(2 * std::numbers::pi)) + std::log(determinant));
}

double position_entropy(const Leaf& leaf, int dims) {
  MixtureBound bound(dims);
  for (const ModelState& model : leaf.models) bound.add(model.weight, model);
  return bound.value();
}

double position_entropy(const ObjectBelief& object, const Background& background) {
  MixtureBound bound(background.dims);
  for (const auto& version : object.versions)
    for (const ModelState& model : version.leaf.models)
      bound.add(version.weight(object.p) * model.weight, model);
  return bound.value();
}

double class_entropy(const ObjectBelief& object, const Background& background) {
  return discrete_entropy(object.classes(background));
}

double attribute_entropy(const ObjectBelief& object) {
  double sum = 0;
  for (const auto& version : object.versions)
    for (const AttributeBelief& belief : version.leaf.attributes)
      sum += version.weight(object.p) * entropy_of(belief);
  return sum;
}

double entropy(const ObjectBelief& object, const Background& background) {
  if (object.p <= 0) return 0;
  const double p = std::min(object.p, 1.0);
  return binary_entropy(p) + p * (position_entropy(object, background) +
                                  class_entropy(object, background) + attribute_entropy(object));
}

BeliefEntropy entropy(const Belief& belief, Utime at, double min_p, const Background& background) {
  BeliefEntropy out{0, -std::numeric_limits<double>::infinity(), 0};
  for (const ObjectBelief& object : read_objects(belief, at, min_p, background)) {
    const double h = entropy(object, background);
    out.sum += h;
    out.max = std::max(out.max, h);
    ++out.objects;
  }
  return out;
}

}  // namespace anchord
