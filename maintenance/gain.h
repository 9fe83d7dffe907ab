#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "maintenance/covariance.h"
#include "maintenance/site.h"
#include "maintenance/subject.h"

namespace anchord {

/// One look of an eye, `time` seconds after the subjects were read.
struct Glance {
  int eye = 0;  ///< index into Site::eyes
  BasePose base;
  double time = 0;
};

/// The forward simulation of thesis section 3.5.2: what would be believed about all subjects if
/// robots looked so, with fake measurements at the predicted means (3.6).
///
/// Each look that has a component's mean in view detects it with the eye's probability q. Two
/// branches are kept per component, with their probabilities: not yet detected, and detected at
/// least once. Mass that goes from the first to the second has its covariance updated by Kalman's
/// rule; the mass there already follows P' = P - q K H P (Sinopoli et al., "Kalman filtering with
/// intermittent observations", IEEE T-AC 49(9), 2004), and the two are averaged. Existence and the
/// weights of components after misses follow Bayes' rule; a miss is taken to say nothing about
/// where inside a component the object is.
///
/// What is a bound: the Kalman update and ln|P| are concave in P, so averages make the entropy too
/// large: for one Gaussian the gain is a lower bound, exact for one look, and for q = 1. In a
/// mixture a detection is taken to tell which component it is of, which makes the gain too large
/// where components overlap; the entropy without a detection is that of component and position
/// together, an upper bound (entropy.h). Detected objects that enter `somewhere` are not seen
/// again, and later detections tell nothing more about the class: both make the gain too small.
///
/// A value: the state after some looks; copying one shares the subjects, which must outlive it.
class Forecast {
 public:
  Forecast(const std::vector<Subject>& subjects, const Site& site);

  /// Takes a look; looks come in order of time.
  void look(const Glance& look);
  /// As if no look had been taken.
  void reset();
  /// Takes back the looks since `earlier`, which this was a copy of. Cheaper than copying it again.
  void back_to(const Forecast& earlier);
  /// The sum over subjects of H(without the looks) - E H(with them), both at `time`, not before the
  /// last look, nat.
  double gain(double time) const;
  /// The same of one subject.
  double gain_of(int subject, double time) const;
  /// Subjects that some look had in view.
  const std::vector<int>& seen() const { return seen_; }
  bool sees(int subject) const { return is_seen_[subject] != 0; }
  /// H of a subject at `time` without the looks, and E H with them, nat.
  struct Entropies {
    double without, with;
  };
  Entropies entropies(int subject, double time) const;
  int subjects() const { return static_cast<int>(subjects_->size()); }

 private:
  /// What the looks did to a track: the masses of its two branches, as of `time`.
  struct Branches {
    double undetected = 0, detected = 0;
    Covariance covariance;  ///< of the second branch
    double time = 0;
  };
  /// What the looks did to a subject beside its tracks; probabilities given that it exists.
  struct Rest {
    double lost_undetected = 0, lost_detected = 0;  ///< gone from a track into `somewhere`
    double found = 0;                               ///< detected in a tile
    Covariance covariance;                          ///< of that
    double time = 0;                                ///< of that
    double class_gain = 0;                          ///< nat, over the detected
  };
  /// Means of tracks and tiles in a row, and which subject's they are.
  struct Plan;
  struct Sight;

  void touch(int subject);
  void reset(int subject);
  Branches at(int track, double time, Rest& rest) const;
  void see_track(int track, const Sight& sight);
  void see_tile(int tile, const Sight& sight);

  const std::vector<Subject>* subjects_;
  const Site* site_;
  std::shared_ptr<const Plan> plan_;
  std::vector<Branches> tracks_;
  std::vector<double> tiles_;  ///< undetected mass
  std::vector<Rest> rest_;     ///< per subject
  std::vector<char> is_seen_;
  std::vector<int> seen_;
};

/// The expected information gain of some looks, at `end`, nat.
double expected_gain(const std::vector<Subject>& subjects, const std::vector<Glance>& looks,
                     double end, const Site& site);

}  // namespace anchord
