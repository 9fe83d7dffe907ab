#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "knowledge/knowledge.h"
#include "tests/anchoring/enumerated_object.h"

/// What the enumeration knows of detections that objects share.
namespace anchord::enumeration {

/// The density of a detection at a state's position, measured with its covariance.
double density_at(const Moments& state, const Measurement& z);

/// What a detection's size says of an object: 1 everywhere where nothing is known.
struct Sizes {
  double larger = 1;   ///< the probability that it is 1.2 times larger
  double alone = 1;    ///< its density if it is of such an object alone, over its reference
  double at_best = 1;  ///< of all scalars, the most that can be
};
Sizes sizes(const Object& object, const BehaviourModel& model, const Measurement& z,
            const Knowledge& knowledge);
/// What the attributes of a detection that it shares are worth for an object.
double joint_ratio(const Sizes& size);

/// How probable it is, for each detection and then for none of them, that an object in a model is
/// hidden there.
std::vector<double> hidden_in(const Object& object, const Moments& state,
                              const BehaviourModel& model,
                              const std::vector<Measurement>& detections,
                              const Knowledge& knowledge);

/// What was learned holds only with a probability; else it is as before.
void doubt_attributes(Object& object, const std::map<int, Eigen::VectorXd>& symbols_before,
                      const std::map<int, ScalarReport>& scalars_before, double own);

}  // namespace anchord::enumeration
