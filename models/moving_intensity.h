#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "geometry/region.h"
#include "geometry/view.h"
#include "models/kinematic.h"

namespace anchord {

/// What arrives on the move, of one class, and how it moves until it is first detected.
struct MovingArrivals {
  struct Source {
    Kinematic density;    ///< of an object at the moment that it arrives
    double rate = 0;      ///< arrivals per s
    double at_start = 0;  ///< expected number that have just arrived as time begins
    bool operator==(const Source&) const = default;
  };
  std::vector<Source> sources;
  bool constant_velocity = true;  ///< else a random walk
  ByAxis psd;                     ///< as predict_constant_velocity() or _position() takes it
  double departure_rate = 0;      ///< mu, 1/s
  int dims = 3;
  bool operator==(const MovingArrivals&) const = default;
};

/// The expected number of objects of one class that arrived on the move, exist and have never been
/// detected, as a mixture of normal densities over position and velocity: the Poisson intensity of
/// the PMBM filter (Williams 2015, IEEE TAES 51(3); Garcia-Fernandez et al. 2018, IEEE TAES 54(4)),
/// in continuous time. Time in seconds since the start, where it holds what `at_start` says. A
/// value: copies share the mixture.
///
/// Components of one source stand in order of arrival. Neighbours that one normal density stands
/// for as well are merged by their moments, as are those that hardly count: that changes neither
/// the expected number nor the first two moments.
class MovingIntensity {
 public:
  /// As time begins, `since` s after the start of all.
  explicit MovingIntensity(std::shared_ptr<const MovingArrivals> arrivals, double since = 0);

  struct Component {
    double weight = 0;  ///< expected number
    Kinematic density;
  };
  using Mixture = std::vector<Component>;

  /// The same belief with other arrivals from `time` on (not before its own). Sources are told
  /// apart by their order: of those that are no more, the last one takes what is expected; new ones
  /// begin. Where no source is left nothing is expected. Where nothing differs it is the same to
  /// the bit.
  MovingIntensity continued(std::shared_ptr<const MovingArrivals> arrivals, double time) const;

  /// Predicts to `time` (not before its own): motion, departures, and new arrivals.
  void advance(double time);

  /// A sensor that detects what is in view with probability p(mean of the component) saw nothing
  /// new: each component keeps 1 - p v of its weight, v its mass in view. Returns how many
  /// detections were expected, the sum of p v times weight before.
  double miss(const MapView& view, const std::function<double(const Eigen::Vector3d&)>& p);

  /// How densely such objects would be measured at z: sum of w N(z; H m, H P H' + R), per m^dims.
  double intensity(const Gaussian& z) const;

  /// The density of such an object given its measurement z, by moments; or `still` where the weight
  /// (per m^dims) of that alternative counts. intensity(z) + still_weight must be positive.
  Kinematic found_at(const Gaussian& z, double still_weight, const Kinematic& still) const;

  /// Expected number in a region.
  double expected(const Region& region) const;

  /// Per source, oldest arrivals first.
  const std::vector<Mixture>& mixtures() const { return *mixtures_; }

  /// What changes of it; what arrives does not.
  template <typename Archive>
  void serialize(Archive& archive) {
    archive(time_, mixtures_);
  }

 private:
  std::shared_ptr<const MovingArrivals> arrivals_;
  double time_ = 0;
  std::shared_ptr<const std::vector<Mixture>> mixtures_;
};

}  // namespace anchord
