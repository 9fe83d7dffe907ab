#pragma once

#include "anchoring/leaf.h"

namespace anchord {

/// Objects that touch and are detected as one. A behaviour model may say that an object in it
/// shares its detections with others (BehaviourModel::shares()). Its density is of where that
/// detection is; and, in the place of a velocity, of how far the object itself is from there, m.
/// One of those that share a detection gives it; the others are hidden in it. (Elfring 2014,
/// section 2.3.2, has at most one object to a detection, assumption II; figure 2.5d is where that
/// fails.)

/// Where an object itself is, once it no longer shares what it shared in `model`; at rest.
Kinematic own_place(Kinematic density, const BehaviourModel& model);

/// An object at a place that begins to share a detection: that is somewhere within reach.
Kinematic shared_place(Kinematic density, const BehaviourModel& model, int dims);

/// A sharing model's step over dt seconds: its place among the others is slowly forgotten.
void predict_shared(Kinematic& density, const BehaviourModel& model, double dt, int dims);

/// ln of what the attributes of a detection that it shares are worth for an object, in place of the
/// L_A of all: its size, if one is configured, is larger than the object's, and all scalars are as
/// good as any that were known before; else nothing.
double log_shared_ratio(const Leaf& leaf, const MapDetection& z, const BehaviourModel& model,
                        const Background& background);

/// Lowers what is shown of a predicted leaf by what may be hidden in the frame's detections: what
/// is hidden is not missed.
void hide(const Leaf& leaf, const MapFrame& frame, const Background& background,
          LeafVisibility& shown);

/// The densities of a predicted leaf that gave nothing, where it may be hidden: drawn to the
/// detections, as far as it is probable that it is in them; by moments. `shown` is after hide().
/// Returns the detection that it is in with probability above 1/2, or -1.
int draw_to_hosts(Leaf& leaf, const MapFrame& frame, const LeafVisibility& shown,
                  const Background& background);

/// Detections of one object reported once more: the density (per m^d) of a repeat, at the z-th
/// detection, of those of the frame that have a higher score, or the same and are earlier. It comes
/// to what clutter is there.
double repeat_density(const MapFrame& frame, int z, int dims);

}  // namespace anchord
