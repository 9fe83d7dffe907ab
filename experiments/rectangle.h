#pragma once

#include <Eigen/Core>

#include "experiments/dice.h"

namespace anchord::experiment {

/// A rectangle in the plane: corners of least and of greatest x and y.
struct Rectangle {
  Eigen::Vector2d low, high;
  bool contains(const Eigen::Vector2d& p) const {
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  }
  Eigen::Vector2d draw(Dice& dice) const {
    const double x = dice.uniform(low.x(), high.x());
    return {x, dice.uniform(low.y(), high.y())};
  }
};

}  // namespace anchord::experiment
