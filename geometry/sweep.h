#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geometry/ray_mass.h"

namespace anchord {

/// Sums over the directions between two angles in which a density of the plane is seen from the
/// origin, by quadrature where exp(log_weight(u)) is not next to nothing; u is the direction's unit
/// vector, and use(u, d) takes it with the angle d that it stands for.
class Sweep {
 public:
  /// What is further away than so many standard deviations is nowhere.
  static constexpr double kFar = 5.3;

  Sweep(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance)
      : plane_(plane_of(mean, upper_factor<2>(covariance))) {}

  /// The widest part of a turn that is looked at as one; on a curve it may hold several bells.
  static constexpr double kRays = std::numbers::pi, kCurve = std::numbers::pi / 3;

  template <typename LogWeight, typename Use>
  void operator()(double low, double high, double widest, const LogWeight& log_weight,
                  const Use& use) const {
    const double first = plane_.direction_of(low), last = plane_.direction_of(high);
    for (int turn = -1; turn <= 2; ++turn) {
      const double centre = plane_.peak + 2 * std::numbers::pi * turn;
      const double from = std::max(first, centre - plane_.reach),
                   to = std::min(last, centre + plane_.reach);
      if (from >= to) continue;
      const int panels = static_cast<int>(std::ceil((to - from) / widest));
      const double width = (to - from) / panels;
      for (int i = 0; i < panels; ++i) panel(from + width * i, width, log_weight, use);
    }
  }

 private:
  static WhitePlane plane_of(const Eigen::Vector2d& mean, const Eigen::Matrix2d& factor) {
    return {factor, solve_upper(factor, mean), kFar};
  }
  static Eigen::Vector2d rotated(const Eigen::Vector2d& v, double cosine, double sine) {
    return {cosine * v.x() - sine * v.y(), sine * v.x() + cosine * v.y()};
  }

  template <typename LogWeight, typename Use>
  void panel(double from, double width, const LogWeight& log_weight, const Use& use) const {
    constexpr double kWide = 1.2;
    constexpr int kFew = 8, kMany = 16;
    const int steps = width < kWide ? kFew : kMany;
    constexpr double kDeep = 9;  // what is lower is 3e-5 of a bell
    const double step = width / steps;
    std::array<double, kMany + 1> logs;
    Eigen::Vector2d white(std::cos(from), std::sin(from));
    const Eigen::Vector2d turn(std::cos(step), std::sin(step));
    for (int i = 0; i <= steps; ++i) {
      logs[i] = log_weight((plane_.factor * white).normalized());
      white = rotated(white, turn.x(), turn.y());
    }
    const auto most = std::max_element(logs.begin(), logs.begin() + steps + 1);
    if (*most < -kFar * kFar / 2) return;
    const int top = static_cast<int>(most - logs.begin());
    int first = 0, last = steps;
    while (first < top && logs[first + 1] < *most - kDeep) ++first;
    while (last > top && logs[last - 1] < *most - kDeep) --last;
    // Gauss and Legendre's ten nodes.
    static constexpr std::array<double, 5> kNode = {0.1488743389816312, 0.4333953941292472,
                                                    0.6794095682990244, 0.8650633666889845,
                                                    0.9739065285171717};
    static constexpr std::array<double, 5> kWeight = {0.2955242247147529, 0.2692667193099964,
                                                      0.2190863625159820, 0.1494513491505806,
                                                      0.0666713443086881};
    const double middle = from + step * (first + last) / 2, half = step * (last - first) / 2;
    const double area = plane_.factor(0, 0) * plane_.factor(1, 1);
    const Eigen::Vector2d centre(std::cos(middle), std::sin(middle));
    const auto node = [&](double cosine, double sine, double weight) {
      const Eigen::Vector2d at = plane_.factor * rotated(centre, cosine, sine);
      const double length2 = at.squaredNorm();
      use(Eigen::Vector2d(at / std::sqrt(length2)), half * weight * area / length2);
    };
    for (std::size_t i = 0; i < kNode.size(); ++i) {
      const double cosine = std::cos(half * kNode[i]), sine = std::sin(half * kNode[i]);
      node(cosine, -sine, kWeight[i]);
      node(cosine, sine, kWeight[i]);
    }
  }

  WhitePlane plane_;
};

}  // namespace anchord
