#pragma once

#include "tools/anchor_tune/matching.h"

namespace anchord::tuning {

/// How dense a sensor's false detections are where its right ones are, relative to an even spread
/// over the view: kappa competes with objects there, not in the sky. Pairs of a right and a false
/// detection of different frames within `radius` m in the sensor's frame are counted, against those
/// that an even spread of the false ones leads to expect. 1 where fewer than kLeastPairs are to be
/// had, or less than kEven times what was expected: chance, and the view's edges.
double crowding(const Judgement& judgement, int sensor, double radius, int dims);
inline constexpr int kLeastPairs = 30;
inline constexpr double kEven = 1.5;

}  // namespace anchord::tuning
