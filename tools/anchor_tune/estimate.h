#pragma once

#include <cstdint>
#include <string>

namespace anchord::tuning {

/// A number that was estimated, with its interval of 95 % confidence.
struct Estimate {
  double value = 0, low = 0, high = 0;

  /// "0.93 (95 %: 0.92 to 0.94)".
  std::string text() const;
};

/// Events per unit of exposure (> 0), after `count` of them: count / exposure, with the exact
/// interval of a Poisson mean (Garwood 1936).
Estimate poisson_rate(std::int64_t count, double exposure);

/// A probability after `count` successes in `trials` (> 0): the share, with the exact interval of a
/// binomial (Clopper and Pearson 1934).
Estimate binomial_share(std::int64_t count, std::int64_t trials);

/// A variance relative to what was expected: `sum` of `count` (> 0) squares of normalised
/// residuals, over their number, with the interval of the chi-squared distribution.
Estimate variance_scale(double sum, std::int64_t count);

/// A number with four significant digits, for people.
std::string rounded(double value);

}  // namespace anchord::tuning
