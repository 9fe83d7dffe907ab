#pragma once

#include <optional>
#include <vector>

#include "tools/anchor_tune/matching.h"

namespace anchord::tuning {

/// How a sensor's reports of the class are to be read.
struct Labels {
  std::vector<std::vector<int>> counts;        ///< [true][most probable of the reported]
  std::vector<std::vector<double>> confusion;  ///< its rows, with half a count more in each entry
  double loss = 0;            ///< mean -ln P(true class | report), reports taken as likelihoods
  double confusion_loss = 0;  ///< the same, read through the matrix
  int pairs = 0;
  bool confused = false;  ///< the Bayesian information criterion prefers the matrix
};

/// From a sensor's right detections with a class, judged without prior and confusion, so that
/// class_ratio is what was reported. Nothing if there are none, or only one class.
std::optional<Labels> fit_labels(const Judgement& judgement, int sensor, int classes);

}  // namespace anchord::tuning
