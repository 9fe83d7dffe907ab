#pragma once

#include "core/result.h"
#include "core/verification.h"

namespace anchord {

/// Whether a verifier can work on a task from elsewhere, whose numbers may be anything: it has an
/// object and between 1 and kMaxRegions regions with together at most kMaxPolygonPoints corners;
/// all numbers that are used in a world of `dims` are finite and none absurd, probabilities lie in
/// 0..1, covariances are symmetric positive definite. The error names the field.
Status check_task(const Task& task, int dims);

}  // namespace anchord
