#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace anchord {

/// How objects are verified; every number has a use that is told in perception/verifier.h.
struct VerifierSettings {
  /// What a class looks like where a task does not say (thesis figure 3.3).
  struct Appearance {
    std::vector<std::string> colors;  ///< names of NamedColor
    std::array<double, 3> extent{};   ///< length, width, height, m; zeros: unknown
  };
  std::map<std::string, Appearance> appearances;  ///< by class

  double least_visible = 0.8;     ///< share of the predicted density that must have been in sight
                                  ///< before an object counts as absent
  double least_body = 0.5;        ///< share of a body that must be in sight for that
  double least_score = 0.5;       ///< probability of a person
  double least_confidence = 0.8;  ///< of the best of several that it may be
  double size_deviation = 0.1;    ///< of objects of a class, relative
  double pixel_noise = 0.5;       ///< standard deviation of a blob's middle, pixels
  double edge_noise = 0.015;      ///< the same, share of its size in the picture; added
  double depth_noise = 1.5e-3;    ///< of a depth image: standard deviation / depth^2, 1/m
  int looks = 3;                  ///< consecutive ones that decide that an object is missing
};

}  // namespace anchord
