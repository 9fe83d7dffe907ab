// What a miss says of where an object is: how the part of a density that a sensor sees differs from
// the rest.

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "anchoring/visibility.h"
#include "geometry/standard_normal.h"

namespace anchord {
namespace {

/// A factor F of a covariance, F F' = covariance, whose columns lead upward, along the line of
/// sight and across it; each also over the ones after it.
Eigen::Matrix3d along_sight(const Gaussian& density, const Eigen::Vector3d& eye) {
  const Eigen::Vector3d towards = density.mean - eye;
  const double bearing = std::atan2(towards.y(), towards.x());
  Eigen::Matrix3d axes;  // upward, along, across
  axes << 0, std::cos(bearing), -std::sin(bearing), 0, std::sin(bearing), std::cos(bearing), 1, 0,
      0;
  return axes * upper_factor<3>(axes.transpose() * density.covariance * axes);
}

/// Derivatives along the columns of a factor, which a density's moments in white coordinates are,
/// along the map's axes. In a 2-D world the first column is upward, and next to nothing.
MassDerivatives in_map(const Eigen::Vector3d& gradient, const Eigen::Matrix3d& hessian,
                       const Eigen::Matrix3d& factor, int dims) {
  MassDerivatives out;
  if (dims == 3) {
    const Eigen::Matrix3d back = factor.inverse();
    out.gradient = back.transpose() * gradient;
    out.hessian = back.transpose() * hessian * back;
  } else {
    const Eigen::Matrix2d back = factor.topRightCorner<2, 2>().inverse();
    out.gradient.head<2>() = back.transpose() * gradient.tail<2>();
    out.hessian.topLeftCorner<2, 2>() = back.transpose() * hessian.bottomRightCorner<2, 2>() * back;
  }
  return out;
}

/// Points of a density in white coordinates: how many, and the sums of their first and second
/// moments.
struct Points {
  int count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& white) {
    ++count;
    sum += white;
    squares += white * white.transpose();
  }
};

/// Those of a product of two relative masses.
MassDerivatives times(const MassDerivatives& a, const MassDerivatives& b) {
  const Eigen::Matrix3d cross = a.gradient * b.gradient.transpose();
  return {a.gradient + b.gradient, a.hessian + b.hessian + cross + cross.transpose()};
}

/// Those of the probability that no object hides a density; what hides it has its edges along the
/// line of sight and across.
MassDerivatives clear_of_objects(const Gaussian& density, double clear, const Occlusion& occlusion,
                                 std::uint64_t birth, int dims) {
  constexpr double kStep = 0.25;  // standard deviations, over which it hardly bends
  const Eigen::Matrix3d factor = along_sight(density, occlusion.eye());
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  for (int i = 3 - dims; i < 3; ++i) {
    const Eigen::Vector3d step = kStep * factor.col(i);
    const double above = occlusion.clear({density.mean + step, density.covariance}, birth) / clear;
    const double below = occlusion.clear({density.mean - step, density.covariance}, birth) / clear;
    gradient[i] = (above - below) / (2 * kStep);
    hessian(i, i) = (above - 2 + below) / (kStep * kStep);
  }
  return in_map(gradient, hessian, factor, dims);
}

}  // namespace

Visibility::Clear Visibility::clear_of_walls(const Gaussian& density) const {
  // Points of equal probability: most of them across the line of sight, where walls end.
  static constexpr std::array<double, 7> kAcross{-1.4652337927, -0.7916386078, -0.3661063568, 0,
                                                 0.3661063568,  0.7916386078,  1.4652337927};
  static constexpr std::array<double, 3> kElse{-0.9674215661, 0, 0.9674215661};
  const Eigen::Matrix3d factor = along_sight(density, *eye_);
  const std::size_t up = background_->dims == 3 ? kElse.size() : 1;
  Points in_view, clear;
  int clear_at_all = 0;
  for (const double across : kAcross)
    for (const double along : kElse)
      for (std::size_t k = 0; k < up; ++k) {
        const Eigen::Vector3d white(up > 1 ? kElse[k] : 0, along, across);
        const Eigen::Vector3d at = density.mean + factor * white;
        const bool unhidden = !background_->walls.hide(*eye_, at);
        clear_at_all += unhidden;
        if (!view_.contains(at)) continue;
        in_view.add(white);
        if (unhidden) clear.add(white);
      }
  if (in_view.count == 0)
    return {clear_at_all / static_cast<double>(kAcross.size() * kElse.size() * up), {}};
  if (clear.count == 0 || clear.count == in_view.count)
    return {static_cast<double>(clear.count) / in_view.count, {}};
  const double all = in_view.count, some = clear.count;
  const Eigen::Vector3d mean = in_view.sum / all, apart = clear.sum / some - mean;
  const Eigen::Matrix3d cross = apart * mean.transpose();
  const Eigen::Matrix3d change =
      clear.squares / some - in_view.squares / all - cross - cross.transpose();
  return {some / all, in_map(apart, change, factor, background_->dims)};
}

SeenPart Visibility::part(const Gaussian& density, double seen, const Occlusion& occlusion,
                          std::uint64_t birth) const {
  double in_view = seen;
  MassDerivatives hidden;
  if (eye_) {
    const Clear clear = clear_of_walls(density);
    in_view /= clear.share;
    hidden = clear.relative;
  }
  if (const double clear = occlusion.clear(density, birth); clear < 1) {
    in_view /= clear;
    hidden = times(hidden, clear_of_objects(density, clear, occlusion, birth, background_->dims));
  }
  MassDerivatives relative = view_.mass_derivatives(density);
  relative.gradient /= in_view;
  relative.hessian /= in_view;
  return {seen, times(relative, hidden)};
}

void Sight::miss(Kinematic& density, double p, double seen) const {
  if (p * seen * (1 - seen) < kHardlyNews * (1 - p * seen)) return;
  const SeenPart part = visibility.part(density.position_density(), seen, occlusion, birth);
  anchord::miss(density, p, part, visibility.dims());
}

}  // namespace anchord
