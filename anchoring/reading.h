#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "anchoring/belief.h"

namespace anchord {

/// What is believed about one object at one time, over all hypotheses of its cluster.
///
/// Which anchor an object is in worlds other than the one shown is a matter of names: a thing that
/// is there for certain may be an old object in one world and a new one in the next. So an object
/// that stands in the best world is meant in every world: as its own anchor, and where that is not
/// there as another one that is not in the best world and had one of its last detections (of the
/// last `scan_depth` frames). That one is then not counted for itself, so that what is expected of
/// all objects together is what it is of all anchors. With `scan_depth` 0 an anchor is what its
/// name says.
struct ObjectBelief {
  /// One leaf, predicted to the time of the reading, as_real().
  struct Version {
    double probability = 0;  ///< that its leaf is the true one: the sum of P(h) over hypotheses
    Leaf leaf;
    /// Of this version in the density of the object given that it exists, which has probability
    /// `exists`.
    double weight(double exists) const {
      return exists > 0 ? probability * leaf.existence / exists : 0;
    }
  };
  std::shared_ptr<const Anchor> anchor;
  double p = 0;          ///< that it exists and is no phantom
  int best = -1;         ///< the version in the most probable hypothesis, or -1
  bool in_best = false;  ///< stands in the best world: that version has r >= 0.5
  std::vector<Version> versions;

  /// Mean and covariance of the position, given that it exists.
  Gaussian moments(const Background& background) const;
  /// P(in the place | exists); `place` -1 is the world's bounds.
  double in_place(int place, const Background& background) const;
  /// Whether that is at least a half.
  bool mostly_in(int place, const Background& background) const;
  /// P(outside every place | exists).
  double outside_places(const Background& background) const;
  /// The deepest place that holds at least half of the density, or -1.
  int place(const Background& background) const;
  /// Marginal class distribution, given that it exists.
  std::vector<double> classes(const Background& background) const;
  /// The leaf that stands for the object: that in the best world, else the likeliest.
  const Leaf& shown() const;
  /// When shown() was last given a detection.
  Utime last_seen() const;
};

/// What an object is asked to be: every part must hold. Empty: anything.
struct Description {
  struct Term {
    int attribute;  ///< index into Knowledge::attributes
    int symbol;     ///< a categorical attribute's symbol, a scalar's predicate
  };
  std::vector<Term> terms;
};

/// P(the leaf fits | it exists). An attribute it does not hold: uniform; a scalar: 0.
double match(const Leaf& leaf, const Description& description, const Background& background);
/// The same over all versions of an object.
double match(const ObjectBelief& object, const Description& description,
             const Background& background);

/// Position density of a leaf's best tracked model (most weight); what a best world shows.
const Kinematic& position_of(const Leaf& leaf);
/// How that moves, m/s; 0 where it shares a detection with others, whose motion says little.
Eigen::Vector3d velocity_of(const Leaf& leaf, const Background& background);

/// Moments of a leaf's whole density over position.
Gaussian moments(const Leaf& leaf);
/// The mass of a leaf's density in a place (-1: the world's bounds).
double mass_in_place(const Leaf& leaf, int place, const Background& background);

/// The mass of a leaf's density outside every place.
double mass_outside_places(const Leaf& leaf, const Background& background);

/// A leaf at a time not before its own, as_real(); its densities as looks have told them.
Leaf leaf_at(const Leaf& leaf, Utime at, const Background& background);

/// Every anchor of p >= min_p at time `at` (not before the belief's), in order of birth.
std::vector<ObjectBelief> read_objects(const Belief& belief, Utime at, double min_p,
                                       const Background& background);

/// Those of one cluster, in its order.
std::vector<ObjectBelief> read_objects(const Cluster& cluster, Utime at,
                                       const Background& background);

/// Distribution of the number of anchors that exist, fit the description and are in the place
/// (-1: anywhere): the Poisson-binomial inside each hypothesis, mixed over hypotheses, convolved
/// over clusters. Entries beyond the last that matters (1e-15) are left out.
std::vector<double> count_distribution(const Belief& belief, Utime at,
                                       const Description& description, int place,
                                       const Background& background);

/// Expected number of objects never detected that fit the description, in a place (-1: in the
/// bounds). Attributes other than the class are unknown of them: uniform over symbols, a scalar's
/// predicate never known to hold.
double undetected(const Belief& belief, Utime at, const Description& description, int place,
                  const Background& background);

}  // namespace anchord
