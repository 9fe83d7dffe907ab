#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "core/frame.h"
#include "knowledge/knowledge.h"

namespace anchord::enumeration {

/// Limits that leave the engine exact.
inline constexpr Limits kNoLimits{.max_hypotheses = 0,
                                  .min_weight = 0,
                                  .gate_probability = 1,
                                  .scan_depth = 0,
                                  .min_existence = 0,
                                  .min_probability = 0,
                                  .min_symbol = 0};

/// What a random scene has, beside detections, misses and clutter.
struct Variety {
  bool three_d = false;         ///< a 3-D world
  bool classes = false;         ///< 2 or 3 classes, reported, with a prior or confusion
  bool attributes = false;      ///< a categorical and a scalar one
  bool changes = false;         ///< with `attributes`: they change, at rates of the class
  bool scores = false;          ///< on some detections
  bool several_models = false;  ///< two tracked models that change into each other
  bool undetectable = false;    ///< a model that is never detected beside the first
  bool shared = false;          ///< a model whose objects share detections beside the first
  bool doubled = false;         ///< sensors that report things twice
  bool somewhere = false;       ///< models over places or the world, with small R in mid-cell
  bool views = false;           ///< rectangles and L-shapes along cell borders, none, configured
  bool correlated = false;      ///< covariances of detections that are not diagonal
  bool departures = false;      ///< objects leave
  bool arrivals = false;        ///< uniform ones and at places
  bool outside = false;         ///< detections outside the bounds
  bool sensors = false;         ///< three of them, sometimes at one instant
  bool late = false;            ///< with `sensors`: some frames arrive late
  bool verification = false;    ///< detections that name their object, as reference() does
  bool phantoms = false;        ///< with `classes`: one of them is a phantom
  bool looks = false;           ///< with `classes`: what is false looks like one of them
  bool ranged = false;          ///< sensors say where they are; p_D depends on the distance
  double max_worlds = 20'000;   ///< detections are left out until there are fewer
};

struct Scene {
  Knowledge knowledge;        ///< with limits that leave the engine exact
  std::vector<Frame> frames;  ///< in order of utime
  /// The order in which the frames arrive, as indices: no frame more than max_lateness late,
  /// those of one sensor and those of one utime in order.
  std::vector<std::size_t> arrival;
};

/// Each kind of variety by a coin of its own.
Variety random_variety(std::mt19937_64& random);

/// 2 to 4 frames of 0 to 3 detections. The same generator state gives the same scene everywhere.
Scene random_scene(std::mt19937_64& random, const Variety& variety);

/// How many worlds an enumeration of frames with so many detections has at most.
double count_worlds(const std::vector<std::size_t>& detections, bool departures);

}  // namespace anchord::enumeration
