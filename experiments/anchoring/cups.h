#pragma once

#include <string>
#include <vector>

#include "experiments/anchoring/camera.h"
#include "knowledge/knowledge.h"

namespace anchord::experiment {

/// One frame of the ambiguity with cups (thesis section 2.6.2).
struct CupsShot {
  double time = 0;   ///< s
  std::string part;  ///< `before`, `hidden`, `partial`, `after`
  Frame frame;
};

/// A tea can, a tea box and a cup on the table, seen for 4 s; all hidden for 5 s, in which a second
/// cup is put there; for 4 s only the part with that one in sight; then all again. 10 Hz. The
/// detector measures position and class label.
std::vector<CupsShot> simulate_cups(Dice& dice);

/// Where the second cup stands.
Eigen::Vector2d second_cup();

/// What is believed of the cup that turned up at second_cup().
struct CupsBelief {
  double moved = 0;       ///< P(it is the cup that was known)
  double new_cup = 0;     ///< P(it is another object)
  bool one_cup = false;   ///< the best world says the known cup is there
  bool two_cups = false;  ///< the best world says both are where they are, the known one at its
                          ///< own place
};

/// Folds the frames; what is believed after each.
std::vector<CupsBelief> watch_cups(const Knowledge& knowledge, const std::vector<CupsShot>& shots);

}  // namespace anchord::experiment
