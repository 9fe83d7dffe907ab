#include "tools/anchor_tune/births.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace anchord::tuning {
namespace {

/// A mixture of normal densities in `dims` dimensions over a uniform one.
class Mixture {
 public:
  Mixture(const std::vector<Eigen::Vector3d>& points, double volume, double least, int dims)
      : points_(points), volume_(volume), least_(least), dims_(dims) {}

  double density(const Gate& gate, const Eigen::Vector3d& x) const {
    const Eigen::MatrixXd covariance = gate.covariance.topLeftCorner(dims_, dims_);
    const Eigen::VectorXd d = (x - gate.mean).head(dims_);
    return std::exp(-0.5 * d.dot(covariance.llt().solve(d))) /
           std::sqrt(std::pow(2 * std::numbers::pi, dims_) * covariance.determinant());
  }

  double uniform_share() const {
    double rest = 1;
    for (const Gate& gate : gates_) rest -= gate.share;
    return std::max(rest, 1e-6);
  }

  double density(const Eigen::Vector3d& x) const {
    double sum = uniform_share() / volume_;
    for (const Gate& gate : gates_) sum += gate.share * density(gate, x);
    return sum;
  }

  double log_likelihood() const {
    double sum = 0;
    for (const auto& x : points_) sum += std::log(density(x));
    return sum;
  }

  /// One component more, where the density is least by how much more it would make of the points
  /// around: with a spread of its nearest points.
  void add() {
    const auto worst =
        std::min_element(points_.begin(), points_.end(),
                         [&](const auto& a, const auto& b) { return worth(a) < worth(b); });
    Gate gate;
    gate.mean = *worst;
    const double spread = std::max(least_, std::pow(volume_, 1.0 / dims_) / 20);
    gate.covariance.topLeftCorner(dims_, dims_).diagonal().setConstant(spread * spread);
    for (Gate& other : gates_) other.share *= 0.8;
    gate.share = 0.2 * (gates_.empty() ? 4 : 1);
    gates_.push_back(gate);
    for (int i = 0; i < 200; ++i) step();
  }

  const std::vector<Gate>& gates() const { return gates_; }

 private:
  /// Small where many points lie that the mixture does not explain.
  double worth(const Eigen::Vector3d& at) const {
    const double reach = std::pow(volume_, 1.0 / dims_) / 10;
    double unexplained = 0;
    for (const auto& x : points_)
      if ((x - at).head(dims_).norm() < reach) unexplained += 1 / (density(x) * volume_);
    return -unexplained;
  }

  void step() {
    std::vector<Gate> next(gates_.size());
    std::vector<double> sums(gates_.size(), 0.0);
    std::vector<std::vector<double>> shares;
    for (const auto& x : points_) {
      auto& share = shares.emplace_back();
      for (std::size_t k = 0; k < gates_.size(); ++k) {
        share.push_back(gates_[k].share * density(gates_[k], x) / density(x));
        sums[k] += share[k];
        next[k].mean += share[k] * x;
      }
    }
    for (std::size_t k = 0; k < gates_.size(); ++k) {
      if (sums[k] < 1e-9) {
        next[k] = gates_[k];
        next[k].share = 0;
        continue;
      }
      next[k].mean /= sums[k];
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const Eigen::Vector3d d = points_[i] - next[k].mean;
        next[k].covariance += shares[i][k] / sums[k] * d * d.transpose();
      }
      next[k].share = sums[k] / static_cast<double>(points_.size());
      Eigen::Matrix3d& all = next[k].covariance;
      const Eigen::MatrixXd block = all.topLeftCorner(dims_, dims_);
      all.setZero();
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(block);
      all.topLeftCorner(dims_, dims_) =
          solver.eigenvectors() * solver.eigenvalues().cwiseMax(least_ * least_).asDiagonal() *
          solver.eigenvectors().transpose();
    }
    gates_ = std::move(next);
  }

  const std::vector<Eigen::Vector3d>& points_;
  double volume_, least_;
  int dims_;
  std::vector<Gate> gates_;
};

}  // namespace

Turnover turnover_of(const Judgement& judgement, int object_class) {
  Turnover out;
  struct Life {
    Utime first, last;
  };
  std::map<std::pair<int, std::string>, Life> lives;
  std::map<int, std::vector<Utime>> looked;  // per recording
  for (const JudgedFrame& frame : judgement.frames) {
    auto& times = looked[frame.recording];
    const bool first_frame = times.empty();
    if (!first_frame) {
      out.exposure += frame.old_seconds;
      out.seconds += seconds_between(times.back(), frame.utime);
    }
    out.new_volume += first_frame ? frame.volume : frame.new_volume;
    times.push_back(frame.utime);
    for (const Sight& sight : frame.sights) {
      if (sight.object_class != object_class) continue;
      const auto [life, born] =
          lives.try_emplace({frame.recording, sight.object}, Life{frame.utime, frame.utime});
      life->second.last = frame.utime;
      if (!born) continue;
      if (sight.seen_before && !first_frame)
        out.arrivals.push_back(sight.position);
      else
        ++out.there;
    }
  }
  for (const auto& [key, life] : lives) {
    const auto& times = looked.at(key.first);
    const auto gone = std::upper_bound(times.begin(), times.end(), life.last);
    out.ends += gone == times.end() ? 0 : 1;
    // It might have stayed until the frame in which it was gone.
    out.object_seconds += seconds_between(life.first, gone == times.end() ? life.last : *gone);
  }
  return out;
}

std::vector<Gate> fit_gates(const std::vector<Eigen::Vector3d>& arrivals, double volume, int most,
                            double least, int dims) {
  Mixture mixture(arrivals, volume, least, dims);
  const double each = 1 + dims + dims * (dims + 1) / 2.0;  // parameters of a component
  const double penalty = each / 2 * std::log(static_cast<double>(arrivals.size()));
  double best = mixture.log_likelihood();
  std::vector<Gate> chosen;
  for (int k = 1; k <= most && k < static_cast<int>(arrivals.size()); ++k) {
    mixture.add();
    const double value = mixture.log_likelihood() - k * penalty;
    if (value <= best) continue;
    best = value;
    chosen = mixture.gates();
  }
  std::erase_if(chosen,
                [&](const Gate& g) { return g.share * static_cast<double>(arrivals.size()) < 1; });
  return chosen;
}

}  // namespace anchord::tuning
