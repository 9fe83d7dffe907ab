#pragma once

#include <cstdint>
#include <string>

#include "knowledge/knowledge.h"
#include "tools/anchor_tune/recording.h"

namespace anchord::tuning {

/// A street seen from above: objects that come, walk and leave, hide now and then, and are detected
/// among clutter. Everything as the belief models it, with numbers that are known.
struct Street {
  double side = 20;  ///< m, of the square world, all of it in view
  int frames = 100;
  double seconds_per_frame = 0.5;
  double psd = 0.02, velocity_variance = 0.25;
  double detection_probability = 0.9;
  double per_m = 0;                    ///< by which its logit changes, from a camera in the corner
  double hide = 0, show = 0;           ///< 1/s; it starts in the chain's stationary state
  double clutter_density = 0.01;       ///< per m^2 and frame
  double arrival_rate = 5e-4;          ///< per m^2 and s
  double departure_rate = 0.02;        ///< 1/s
  double undetected_intensity = 0.02;  ///< per m^2, at the start
  double variance = 0.01;              ///< of detections, m^2

  /// What is detected though it is no object, and moves as objects do; none unless they arrive.
  struct Ghosts {
    double detection_probability = 0.7;
    double arrival_rate = 0;      ///< per m^2 and s
    double departure_rate = 0.1;  ///< 1/s
  } ghosts;
};

/// One sequence with truth.
Recording simulate(const Street& street, std::uint64_t seed);

/// Its configuration, with true numbers.
std::string configuration_of(const Street& street);

/// The same, read.
Knowledge knowledge_of(const Street& street);

}  // namespace anchord::tuning
