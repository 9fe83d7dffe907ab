#pragma once

#include <array>
#include <boost/container/small_vector.hpp>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "anchoring/background.h"
#include "anchoring/map_frame.h"
#include "anchoring/seen_share.h"
#include "core/pool.h"
#include "models/kinematic.h"

namespace anchord {

class Visibility;

/// What a leaf believes about one attribute other than the class.
struct AttributeBelief {
  int attribute = 0;              ///< index into Knowledge::attributes
  PoolVector<double> symbols;     ///< categorical: b_A(s), sums to 1
  double mean = 0, variance = 0;  ///< scalar
};

/// One behaviour model of a leaf: its weight and density.
struct ModelState {
  double weight = 0;
  std::variant<Kinematic, Somewhere> density;
  SeenShare seen = {};  ///< of a tracked density
};

/// One version of an anchor, given one history of associations. A value; all of it holds for
/// `utime`. Class, models and position are kept as a product of marginals.
struct Leaf {
  double existence = 0;                                  ///< r, phantoms included
  boost::container::small_vector<double, 8> classes;     ///< b(c), sums to 1
  int model_class = 0;                                   ///< the class whose models these are
  boost::container::small_vector<ModelState, 2> models;  ///< in the order of that class
  PoolVector<AttributeBelief> attributes;                ///< those reported, ascending
  std::optional<double> yaw;                             ///< last reported, map frame
  ScoreTrace scores;  ///< of its detections, where there are phantoms
  bool held = false;  ///< by a robot: it stays where that is, and a miss says nothing
  Utime utime = 0;
  Utime last_seen = 0;
  /// Which detections it was given in the last scans, as frame number << 16 | detection, ascending.
  boost::container::small_vector<std::uint64_t, 20> recent;

  /// The most probable class; ties go to the first.
  int top_class() const;
  /// Index of the most probable tracked model.
  int top_model() const;
  const AttributeBelief* attribute(int index) const;
};

/// What a frame's view means for a leaf, as predicted to it.
struct LeafVisibility {
  struct Ranged {
    double range;  ///< from the sensor to the density, m
    double p;      ///< sum of b(c) p_D,c there
  };
  double v = 0;                                       ///< sum of w_m v_m
  double p = 0;                                       ///< sum of b(c) p_D,c; ranged: over the view
  boost::container::small_vector<SeenPart, 2> parts;  ///< of tracked models' densities
  boost::container::small_vector<double, 2> v_model;  ///< v_m; 0 for an undetectable model
  boost::container::small_vector<double, 2> factor;   ///< of each density in view, by earlier looks
  /// Per model, where the p_D of some sensor depends on the distance; else empty.
  boost::container::small_vector<Ranged, 2> ranged;

  double q() const { return v * p; }  ///< probability of being detected
  double p_of(std::size_t model) const { return ranged.empty() ? p : ranged[model].p; }
  /// What p is where it is ranged, by the models' shares of what is in view.
  void average(const Leaf& leaf);
  /// The probability that the leaf, if of class c, is detected; v p_D,c or the like.
  double q_of(int c, const Leaf& leaf, const Sensor& sensor) const;
};

/// A density's moments as a behaviour model of another kind holds them: constant_position has no
/// velocity, constant_velocity begins with 0 and its initial variance.
Kinematic as_model(Kinematic density, const BehaviourModel& model, int dims);

/// P(there is such an object): that the leaf's exists and is no phantom.
double real_existence(const Leaf& leaf, const Background& background);

/// The leaf as answers have it: its existence is real_existence(), its classes are those of an
/// object that is no phantom.
Leaf as_real(Leaf leaf, const Background& background);

/// Carries a leaf to `utime`: attributes, departure, behaviour weights, densities.
void predict(Leaf& leaf, Utime utime, const Background& background);

/// l(z|c) for a leaf that z is given to: a phantom's, too, is what the score says beyond the scores
/// before.
double class_ratio(const Leaf& leaf, const MapDetection& z, int c, const Background& background);

/// ln g(z | leaf) of a predicted leaf, not yet counting r; kLogZero where it cannot be. With
/// `gated`, also kLogZero where z lies outside the gates of all behaviour models that carry more
/// weight than the gate leaves out.
double log_likelihood(const Leaf& leaf, const MapDetection& z, const LeafVisibility& shown,
                      bool gated, const Background& background);

/// ln of what z's attributes other than the class are worth, the product of its L_A.
double log_attribute_ratio(const Leaf& leaf, const MapDetection& z, const Background& background);

/// A predicted leaf that is given z, where `shown` is what the frame's view shows of it.
void give(Leaf& leaf, const MapDetection& z, const LeafVisibility& shown, const Sensor& sensor,
          const Background& background);

/// A predicted leaf that is given nothing, where `shown` is what the frame's view shows of it.
void give_nothing(Leaf& leaf, const LeafVisibility& shown, const Visibility& visibility,
                  const Sensor& sensor, const Background& background);

/// The leaf of a new anchor; `terms` are p_D,c lambda_c(z) l(z|c) per class, `existence` their sum
/// over that and clutter. Its position is that of z, at rest; or, if it arrived on the move, what
/// `met` says.
Leaf first_leaf(const MapDetection& z, std::span<const double> terms, double existence, Utime utime,
                const Background& background, const std::optional<Kinematic>& met = std::nullopt);

/// The mixture of two versions of an anchor at the same time, by moments; weights > 0, any sum.
Leaf merge(double weight_a, const Leaf& a, double weight_b, const Leaf& b,
           const Background& background);

/// How much two versions of an anchor at the same time differ: about the total variation between
/// what they say (existence, class, attributes, behaviour, position), 0 to 1; 1 where the models
/// are not comparable. Densities far from alike count as 1. Of what is at least `most`, only that
/// it is.
double difference(const Leaf& a, const Leaf& b, const Background& background, double most = 1);

/// Moves the densities to the models of the most probable class, if that has changed.
void follow_class(Leaf& leaf, const Background& background);

/// The models that a leaf's states are of, where they are not its class's any more.
struct FormerModels {
  static constexpr int kNoPlace = -2;
  std::span<const BehaviourModel> models;  ///< places are the background's, or kNoPlace
  /// Per state whether it is somewhere that an event has told, not in its model's place.
  boost::container::small_vector<bool, 8> told;
};

/// Gives the leaf the models of class c: each density goes to the one of the same kind and place,
/// else by its moments into the first tracked one (a `somewhere`: into the first `somewhere`,
/// uniform over its place). Weights add up.
void change_models(Leaf& leaf, const FormerModels& former, int c, const Background& background);

}  // namespace anchord
