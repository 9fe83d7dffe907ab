#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "experiments/anchoring/camera.h"
#include "knowledge/knowledge.h"

namespace anchord::experiment {

/// Two like cups change their places while nobody looks, and for how long nothing tells which is
/// which.
enum class Ambiguity {
  /// Both are hidden, and one is moved.
  kHidden,
  /// One is moved to between the places of both; only that one can be seen until the view of all
  /// tells which of the old places is empty.
  kOneInSight,
  /// Both are moved; both can be seen, but not their colors, until these tell which is which.
  kNoColor,
  /// The same, put so close to each other that a detection may be of either.
  kSideBySide,
};

/// Which cups are to be seen, and when.
struct HiddenScene {
  Ambiguity ambiguity = Ambiguity::kHidden;
  double seconds = 1;          ///< the ambiguity lasts
  double false_positives = 0;  ///< per frame, with labels like a cup's
};

/// A simulated one.
struct HiddenFootage {
  std::vector<Frame> frames;
  std::size_t known = 0;                    ///< frames from the start until the cups change places
  std::size_t settled = 0;                  ///< the first frame of the evidence that settles it
  std::array<Eigen::Vector2d, 2> from, to;  ///< where each cup was, and is
  double near = 0;                          ///< m: what is nearer to a cup is where it is
};

/// 3 s of both cups, with their colors; what the ambiguity is; then 2 s of both cups, with their
/// colors if these are what tells. 20 Hz.
HiddenFootage simulate_hidden(const HiddenScene& scene, Dice& dice);

struct HiddenOutcome {
  bool right = false;      ///< the best world has each cup where it is, under its own name
  double probability = 0;  ///< of that, over all hypotheses
  double kept = 0;         ///< the same just before the settling evidence, as far as was in view
};

HiddenOutcome watch_hidden(const Knowledge& knowledge, const HiddenFootage& footage);

}  // namespace anchord::experiment
