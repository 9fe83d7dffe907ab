#pragma once

#include <functional>

#include "knowledge/knowledge.h"
#include "tools/anchor_tune/finding.h"
#include "tools/anchor_tune/optimum.h"
#include "tools/anchor_tune/recording.h"

namespace anchord::tuning {

/// One number of a configuration that frames alone can tell something about.
struct Parameter {
  JsonPath path;  ///< of the number
  Scale scale = Scale::kLog;
  double start = 0;
  std::function<void(Knowledge&, double)> set;
};

/// The parameters of every class and of the sensors named: clutter density; detection probability,
/// arrival and departure rate, undetected intensity, transitions between tracked models, and, where
/// all tracked models of a class are of one kind, their motion, which they share. A number that is
/// 0 (a probability of 0) stays so, and is left out. `knowledge` gets settings of its own for each
/// of the sensors.
std::vector<Parameter> parameters_of(Knowledge& knowledge, const std::vector<std::string>& sensors);

/// ln p(frames) under a configuration: Belief::log_evidence after each recording, summed. Where
/// detections carry scores, kappa is the density of clutter that looks like a right detection, and
/// all clutter is that times the odds against: sum of 1 - p over sum of p, over all detections of
/// the sensor; the expected number is put right by it. Refuses what World::apply() refuses.
Result<double> log_evidence(const Knowledge& knowledge, const std::vector<Recording>& recordings);

/// The most likely numbers, starting from `knowledge`, after at most about `evaluations` of the
/// evidence; intervals from its curvature.
Result<Findings> findings_from_frames(const std::vector<Recording>& recordings, Knowledge knowledge,
                                      int evaluations);

}  // namespace anchord::tuning
