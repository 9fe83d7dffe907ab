#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "anchoring/reading.h"
#include "knowledge/knowledge.h"

namespace anchord {

/// What the forward simulation needs of one object: its belief, made short. Read once per choice.
/// Times are seconds since the reading. A value.
struct Subject {
  /// A Gaussian component: a tracked model of some leaves.
  struct Track {
    double weight = 0;   ///< of the density given that the object exists
    Kinematic state;     ///< at the reading
    ByAxis psd;          ///< of its model: m^2/s, or m^2/s^3 where `moves`
    bool moves = false;  ///< constant velocity
    double leak = 0;     ///< 1/s at which it enters `somewhere`
    bool detectable = true;
  };
  /// A part of a `somewhere`.
  struct Tile {
    double weight = 0;
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    double volume = 0;  ///< m^dims
  };

  std::string id;      ///< of the anchor
  int top_class = 0;   ///< index into Knowledge::classes
  double p = 0;        ///< that it exists
  bool target = true;  ///< false: counts when it comes into view, but nobody sets out for it
  std::vector<Track> tracks;
  std::vector<Tile> tiles;
  double lost_entropy = 0;  ///< of where a track that leaks goes, nat
  double class_entropy = 0, attribute_entropy = 0;
  /// Per sensor of Knowledge, over its classes: means of what it is near at hand and of how it
  /// changes with the distance.
  std::vector<DetectionProbability> detection_probability;
  std::vector<double> class_gain;    ///< per sensor: what one detection tells of the class
  ByAxis initial_velocity_variance;  ///< of the model a found object goes to
  ByAxis found_psd;
  bool found_moves = false;

  /// The mean of the heaviest component: where one looks for it.
  Eigen::Vector3d mean() const;
};

/// An object that rests or wanders as one Gaussian: constant_position with that psd.
Subject single_subject(std::string id, const Gaussian& position, double psd, double p,
                       int top_class, const Knowledge& knowledge);

/// Of an object at the time of its reading. Components that are alike are merged by moments, and
/// beyond kMaxTracks the nearest, so that their number is bounded.
Subject subject_of(const ObjectBelief& object, const Background& background);

/// Every anchor of p >= min_p.
std::vector<Subject> read_subjects(const Belief& belief, Utime at, double min_p,
                                   const Background& background);

inline constexpr std::size_t kMaxTracks = 4;
inline constexpr int kTilesPerPlace = 16;

}  // namespace anchord
