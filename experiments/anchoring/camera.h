#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/frame.h"
#include "experiments/rectangle.h"

namespace anchord::experiment {

/// The top of the table of thesis section 2.6, 1.2 x 0.8 m, in the map's plane.
inline Rectangle table() { return {{0, 0}, {1.2, 0.8}}; }

/// A simulated detector that looks at the table: positions with the covariance of thesis section
/// 2.6.1, false negatives, and false positives anywhere on the table, Poisson.
class Camera {
 public:
  Camera(std::string name, double detection_probability, double false_positives, Dice& dice)
      : name_(std::move(name)),
        detection_probability_(detection_probability),
        false_positives_(false_positives),
        dice_(dice) {}

  /// A frame `time` seconds after the start with nothing in it yet, and a view of one part of the
  /// table; without one, all is hidden.
  Frame frame(double time, const std::optional<Rectangle>& seen) const;

  /// What is reported of an object there, or nothing: a false negative.
  std::optional<Detection> look(const Eigen::Vector2d& position);

  /// A frame's false positives: anywhere above the table, up to where things on it reach; those in
  /// the part that is seen.
  std::vector<Detection> false_positives(const Rectangle& seen);

  /// A measured position of something there, at the height of the things on the table.
  Detection measured(const Eigen::Vector2d& position);

 private:
  std::string name_;
  double detection_probability_, false_positives_;
  Dice& dice_;
};

/// A label that is right with the probability that it is reported with; `others`: that it is
/// instead, alike.
AttributeReport label(const std::string& attribute, const std::string& right,
                      const std::vector<std::string>& others, double probability, Dice& dice);

}  // namespace anchord::experiment
