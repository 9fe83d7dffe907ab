#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "tests/anchoring/enumerated_density.h"

namespace anchord::enumeration {

/// A detection as the formulas take it.
struct Measurement {
  Eigen::VectorXd position;
  Eigen::MatrixXd covariance;
  double range = 0;                             ///< from the sensor, m
  Eigen::VectorXd class_ratio;                  ///< m(c) / pi(c); ones if no class is reported
  std::map<int, Eigen::VectorXd> symbol_ratio;  ///< by attribute other than class: m(s) / pi(s)
  std::map<int, ScalarReport> scalar;           ///< by attribute
  double clutter = 0;                           ///< kappa(z)
  double log_odds = 0;                          ///< of its score, where it has one
  std::optional<double> score;                  ///< ln f1/f0 of the same
};

/// Floors, completes and weighs one report of symbols: m(s) / pi(s), or with the sensor's
/// confusion matrix sum_j m(j) C[s][j] over its mean across s.
Eigen::VectorXd symbol_ratio(const SymbolReport& report, const Attribute& attribute,
                             const Sensor& sensor, std::size_t attribute_index);

/// Of a phantom its class_ratio leaves out what the score says.
Measurement measure(const Knowledge& knowledge, const Sensor& sensor, const Detection& detection,
                    const Sight& sight = {});

/// p_D of every class for a sensor at a distance, m.
Eigen::VectorXd detection_probabilities(const Knowledge& knowledge, const Sensor& sensor,
                                        double range);

/// What is believed of an object that exists, in one world.
struct Object {
  int object_class = 0;                    ///< the most probable one, whose models it has
  Eigen::VectorXd classes;                 ///< b(c)
  std::vector<Density> models;             ///< as those of object_class
  std::map<int, Eigen::VectorXd> symbols;  ///< b_A(s) of the attributes that were reported
  std::map<int, ScalarReport> scalars;
  double age = 0;                                 ///< s
  std::vector<std::pair<double, double>> scores;  ///< age, ln f1/f0
};

/// How an object that exists changes.
class Laws {
 public:
  explicit Laws(const Knowledge& knowledge);

  /// Over dt seconds, given that it stays; returns the probability that it leaves.
  double predict(Object& object, double dt) const;
  /// Not detected, though it exists, in a frame of these detections: returns 1 - q.
  double miss(Object& object, const Sensor& sensor, const Sight& sight,
              const std::vector<Measurement>& detections) const;
  /// Detected: returns g(z). Where that is 0 the object cannot have been it, and means nothing
  /// afterwards.
  double detect(Object& object, const Sensor& sensor, const Sight& sight,
                const Measurement& z) const;
  /// First detected; `classes` need not be normalised.
  Object born(const Measurement& z, const Sight& sight, Eigen::VectorXd classes) const;
  /// Mean and covariance of its position over all models.
  Moments position(const Object& object) const;

  const Cells& cells() const { return cells_; }

 private:
  const std::vector<BehaviourModel>& models(const Object& object) const;
  const Extent& extent_of(const BehaviourModel& model) const { return extents_.at(model.place); }
  double visible(const Density& density, const BehaviourModel& model, const Sight& sight) const;
  double mass_in_view(const Density& density, const BehaviourModel& model,
                      const Sight& sight) const;
  /// Of its mean; of a `somewhere` the mean distance of what of the place is in view.
  double range(const Density& density, const BehaviourModel& model, const Sight& sight) const;
  double likelihood(const Density& density, const BehaviourModel& model,
                    const Measurement& z) const;
  /// It is in what was seen.
  void find(Object& object, const Sight& sight) const;
  /// Hands the densities to the models of the class that has become the most probable.
  void follow_class(Object& object) const;

  const Knowledge& knowledge_;
  Cells cells_;
  std::map<int, Extent> extents_;  ///< by place
};

}  // namespace anchord::enumeration
