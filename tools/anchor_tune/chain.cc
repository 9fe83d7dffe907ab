#include "tools/anchor_tune/chain.h"

#include <algorithm>
#include <cmath>

#include "tools/anchor_tune/optimum.h"

namespace anchord::tuning {

double log_likelihood(const Glances& glances, const std::vector<double>& detection_probability,
                      double hide, double show) {
  const double both = hide + show, stationary = both > 0 ? show / both : 1;
  double total = 0, last_seconds = 0, stay = 1;
  for (const auto& looks : glances) {
    double visible = stationary;
    for (const Glance& look : looks) {
      if (look.seconds != last_seconds) {
        last_seconds = look.seconds;
        stay = std::exp(-both * look.seconds);
      }
      if (look.seconds > 0) visible = stationary + (visible - stationary) * stay;
      const double p = detection_probability[static_cast<std::size_t>(look.sensor)];
      const double likelihood = look.found ? visible * p : 1 - visible * p;
      visible = look.found ? 1 : visible * (1 - p) / likelihood;
      total += std::log(likelihood);
    }
  }
  return total;
}

Detectability fit_detectability(const Glances& glances, int sensors) {
  const auto n = static_cast<std::size_t>(sensors);
  std::vector<std::int64_t> found(n, 0), looks(n, 0);
  double seconds = 0;
  for (const auto& object : glances)
    for (const Glance& look : object) {
      ++looks[static_cast<std::size_t>(look.sensor)];
      found[static_cast<std::size_t>(look.sensor)] += look.found ? 1 : 0;
      seconds += look.seconds;
    }
  Detectability result;
  std::vector<double> plain, start;
  double all = 0;
  for (std::size_t s = 0; s < n; ++s) {
    result.detection_probability.push_back(looks[s] > 0 ? binomial_share(found[s], looks[s])
                                                        : Estimate{0.5, 0, 1});
    plain.push_back(result.detection_probability[s].value);
    start.push_back(to_free(std::clamp(plain[s] + (1 - plain[s]) / 2, 0.01, 0.99), Scale::kLogit));
    all += static_cast<double>(looks[s]);
  }
  if (seconds <= 0) return result;
  const auto f = [&](const std::vector<double>& x) {
    std::vector<double> p;
    for (std::size_t s = 0; s < n; ++s) p.push_back(from_free(x[s], Scale::kLogit));
    return log_likelihood(glances, p, std::exp(x[n]), std::exp(x[n + 1]));
  };
  // From a hidden spell of some ten looks, as often as not.
  const double rate = all / seconds / 10;
  start.insert(start.end(), {std::log(rate), std::log(rate)});
  const Optimum best = maximise(f, start, 1, 2000);
  result.gain = best.value - log_likelihood(glances, plain, 0, 0);
  if (!(result.gain > std::log(all))) return result;
  result.hidden = true;
  for (std::size_t s = 0; s < n; ++s)
    if (looks[s] > 0) result.detection_probability[s] = profile_interval(f, best, s, Scale::kLogit);
  result.hide = profile_interval(f, best, n, Scale::kLog);
  result.show = profile_interval(f, best, n + 1, Scale::kLog);
  return result;
}

}  // namespace anchord::tuning
