#pragma once

#include "tools/anchor_tune/finding.h"
#include "tools/anchor_tune/matching.h"
#include "tools/anchor_tune/phantoms.h"

namespace anchord::tuning {

struct TruthOptions {
  double radius = 1;  ///< m, between a detection and the object that it is of
  int gates = 0;      ///< at most so many places where objects come in; 0: they come anywhere
};

/// The numbers of a configuration from recordings that all have truth. Numbers of a class or sensor
/// that there is nothing of stay as they are, and a finding without path says so. Refuses frames
/// that place_in_map() refuses.
Result<Findings> findings_from_truth(const std::vector<Recording>& recordings,
                                     const Knowledge& knowledge, const TruthOptions& options);

/// Of one sensor (index into judgement.sensors): clutter density, score calibration, confusion,
/// noise; with phantoms also what their scores are held against, by label where there are such that
/// look like one. `knowledge` is what the frames were judged with.
Findings sensor_findings(const Judgement& judgement, int sensor,
                         const std::vector<Phantoms>& phantoms, const Knowledge& knowledge,
                         double radius);

/// Of a class that is a phantom, the kind of this number: its models and rates.
Findings phantom_findings(const Judgement& judgement, int object_class, const Phantoms& phantoms,
                          std::size_t number, const Knowledge& knowledge);

/// Of one class: models with their motion, hiding, p_D of each sensor, arrivals and departures.
Findings class_findings(const Judgement& judgement, int object_class, const Knowledge& knowledge,
                        const TruthOptions& options);

}  // namespace anchord::tuning
