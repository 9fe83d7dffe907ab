#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "models/kinematic.h"

namespace anchord {

/// How a sensor's view cuts a density.
struct SeenPart {
  double v = 0;              ///< how much of the density is in view, 0 to 1
  std::uint32_t viewer = 0;  ///< a number of the sensor's own
  double variance = 0;       ///< of the density, variance_of()
  /// The side from which the view reaches into the density, map frame: g with g' P g = 1 for its
  /// covariance P, 1/m, so that g'(x - mean) is how far x is in view, in standard deviations from
  /// the mean on. 0: from no side.
  Eigen::Vector3d toward = Eigen::Vector3d::Zero();
};

/// How wide a density is: its variance of position, the geometric mean over the axes, m^2.
double variance_of(const Kinematic& density, int dims);

/// Where in a tracked density the object may still be, after one sensor's looks at it. A view cuts
/// a density; of two views of one sensor the one that holds more of it is taken to hold all that
/// the other holds, as they do where a still view looks again, or a view's edge or the object moves
/// across. So what was seen is a function of one number: share(v) is the probability that the
/// object stands in the part of its density that a view of mass v holds. It is v before any look,
/// 1 from the last detection's v on, and less than v where the object was missed: what was looked
/// at in vain is not missed again and again.
///
/// A non-decreasing function with share(0) = 0 and share(1) = 1, linear between at most kMost
/// looks. As the density spreads the looks fade. A value, of no size where no look told anything,
/// as for most densities.
class SeenShare {
 public:
  static constexpr std::size_t kMost = 4;

  /// Whether a view that holds so much of a density leaves some of it out.
  static bool cuts(double v);

  /// Of what is in view, before the look has told anything. How the views of two sensors overlap is
  /// not known: what another one saw does not count.
  double share(const SeenPart& part) const;

  /// What the looks have made of the density in that part: share(part) / v, or 1 of one that is not
  /// cut.
  double factor(const SeenPart& part) const;

  /// The object was not found, though with probability `lost` it stood there and would have been;
  /// less than share(part), or 0.
  void miss(const SeenPart& part, double lost);

  /// It was found. Where hardly any of it is in view the view is not what it is said to be, and
  /// nothing is learned.
  void find(const SeenPart& part);

  /// A density with the mean and covariance that it has after the looks, if views cut it along
  /// planes across SeenPart::toward: moments of truncated normal densities.
  Kinematic told(const Kinematic& density, int dims) const;

  /// Of a mixture of two densities; weights > 0, any sum. Of two sensors' looks those of the
  /// weightier density are kept.
  static SeenShare merge(double weight_a, const SeenShare& a, double weight_b, const SeenShare& b);

  /// At most how much the shares of any part differ.
  static double difference(const SeenShare& a, const SeenShare& b);

  /// What it holds, for a checkpoint.
  template <typename Archive>
  void serialize(Archive& archive) {
    archive(curve_);
  }

 private:
  struct Point {
    double v, share;
    template <typename Archive>
    void serialize(Archive& archive) {
      archive(v, share);
    }
  };
  /// The function, with the points between which it is linear.
  struct Curve {
    std::uint32_t viewer = 0;
    double variance = 0;  ///< at the last look
    Eigen::Vector3d toward = Eigen::Vector3d::Zero();
    std::size_t count = 0;
    std::array<Point, kMost> points{};  ///< ascending in v, all in (0, 1)
    template <typename Archive>
    void serialize(Archive& archive) {
      archive(viewer, variance, toward, count, points);
    }

    double at(double v) const;
    /// What is left of the difference that looks made, now that the density has that variance.
    double kept(double now) const;
    /// Makes v one of the points. Where there is no room for so many, others go.
    std::size_t point_at(double v);
    template <std::size_t Most>
    void keep(std::array<Point, Most>& all, std::size_t number, double v);
  };
  double at(double v) const { return curve_ ? curve_->at(v) : v; }

  std::shared_ptr<const Curve> curve_;  ///< none: no look told anything
};

}  // namespace anchord
