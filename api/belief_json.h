#pragma once

#include <nlohmann/json.hpp>

#include "anchoring/reading.h"

namespace anchord {

/// JSON with its members in the order in which they were written.
using Json = nlohmann::ordered_json;

/// The first `dims` numbers of a position, and the dims x dims block of a covariance, row-major.
Json position_json(const Eigen::Vector3d& position, int dims);
Json covariance_json(const Eigen::Matrix3d& covariance, int dims);

/// What a leaf believes about attributes: categorical ones by symbol, scalar ones as mean and
/// variance; the class among them where the configuration has classes.
Json attributes_json(const Leaf& leaf, const Background& background);
/// The same over all versions of an object, given that it exists: mixtures. An attribute that a
/// version does not hold is uniform there; scalars are mixed over the versions that hold them.
Json attributes_json(const ObjectBelief& object, const Background& background);

/// The behaviour models' weights by kind; models of one kind are summed.
Json models_json(const Leaf& leaf, const Background& background);

/// The name of a place, or null for -1.
Json place_json(int place, const Background& background);

/// What a leaf carries through of its object's shape: `yaw` and `extent`, where known.
void add_shape(Json& to, const Leaf& leaf, const Background& background);

/// What was said and done of an object: `alias` and `held_by`, where there are such.
void add_said(Json& to, const Anchor& anchor);

}  // namespace anchord
