#include "tools/anchor_tune/chain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/anchor_tune/optimum.h"

namespace anchord::tuning {
namespace {

/// One way to explain the looks: x is the logits of p_D, then what kRangeStep adds to them, then
/// ln hide and ln show; the latter two as far as it has them.
struct Explanation {
  bool ranged = false, hidden = false;
  LogLikelihood f;
  Optimum best;

  std::size_t parameters() const { return best.at.size(); }
  /// What the Bayesian information criterion compares, of so many looks.
  double worth(double looks) const {
    return best.value - 0.5 * static_cast<double>(parameters()) * std::log(looks);
  }
};

Explanation explain(const Glances& glances, std::size_t sensors, bool ranged, bool hidden,
                    std::vector<double> start, double rate) {
  Explanation out{ranged, hidden, {}, {}};
  out.f = [&glances, sensors, ranged, hidden](const std::vector<double>& x) {
    std::vector<double> p;
    for (std::size_t s = 0; s < sensors; ++s) p.push_back(from_free(x[s], Scale::kLogit));
    const double *rates = x.data() + sensors + ranged, per_step = ranged ? x[sensors] : 0;
    return log_likelihood(glances, p, hidden ? std::exp(rates[0]) : 0,
                          hidden ? std::exp(rates[1]) : 0, from_free(per_step, Scale::kPerMetre));
  };
  if (ranged) start.push_back(0);
  if (hidden) start.insert(start.end(), 2, std::log(rate));
  out.best = maximise(out.f, start, ranged ? 0.5 : 1, 2000);
  return out;
}

}  // namespace

double log_likelihood(const Glances& glances, const std::vector<double>& detection_probability,
                      double hide, double show, double per_m) {
  std::vector<double> near;
  for (const double p : detection_probability) near.push_back(to_free(p, Scale::kLogit));
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
      const auto s = static_cast<std::size_t>(look.sensor);
      const double p = per_m == 0 ? detection_probability[s]
                                  : from_free(near[s] + per_m * look.range, Scale::kLogit);
      const double likelihood = look.found ? visible * p : 1 - visible * p;
      visible = look.found ? 1 : visible * (1 - p) / likelihood;
      total += std::log(likelihood);
    }
  }
  return total;
}

Detectability fit_detectability(const Glances& glances, int sensors, bool may_be_ranged) {
  const auto n = static_cast<std::size_t>(sensors);
  std::vector<std::int64_t> found(n, 0), looks(n, 0);
  double seconds = 0, nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  for (const auto& object : glances)
    for (const Glance& look : object) {
      ++looks[static_cast<std::size_t>(look.sensor)];
      found[static_cast<std::size_t>(look.sensor)] += look.found ? 1 : 0;
      seconds += look.seconds;
      nearest = std::min(nearest, look.range);
      farthest = std::max(farthest, look.range);
    }
  Detectability result;
  std::vector<double> plain, start, half_hidden;
  double all = 0;
  for (std::size_t s = 0; s < n; ++s) {
    result.detection_probability.push_back(looks[s] > 0 ? binomial_share(found[s], looks[s])
                                                        : Estimate{0.5, 0, 1});
    const double p = result.detection_probability[s].value;
    plain.push_back(p);
    start.push_back(to_free(std::clamp(p, 0.01, 0.99), Scale::kLogit));
    half_hidden.push_back(to_free(std::clamp(p + (1 - p) / 2, 0.01, 0.99), Scale::kLogit));
    all += static_cast<double>(looks[s]);
  }
  // As often as not in a hidden spell of some ten looks.
  const double rate = seconds > 0 ? all / seconds / 10 : 1;
  std::vector<Explanation> tried(1);
  tried[0].best = {plain, log_likelihood(glances, plain, 0, 0), 0};
  for (const bool ranged : {false, true})
    for (const bool hidden : {false, true})
      if ((ranged || hidden) && (!ranged || farthest > nearest) && (!hidden || seconds > 0))
        tried.push_back(explain(glances, n, ranged, hidden, hidden ? half_hidden : start, rate));
  const auto less = [&](const Explanation& a, const Explanation& b) {
    return a.worth(all) < b.worth(all);
  };
  result.range_pays = std::max_element(tried.begin(), tried.end(), less)->ranged;
  const Explanation& best = *std::max_element(
      tried.begin(), tried.end(), [&](const Explanation& a, const Explanation& b) {
        const bool no_a = a.ranged && !may_be_ranged, no_b = b.ranged && !may_be_ranged;
        return no_a != no_b ? no_a : less(a, b);
      });
  // What the best of one kind explains better than the best of the other, else like the best.
  const auto gain = [&](bool Explanation::*has, bool Explanation::*like) {
    double with = best.best.value, without = best.best.value;
    for (const Explanation& e : tried)
      if (e.*like == best.*like) (e.*has ? with : without) = e.best.value;
    return with - without;
  };
  result.gain = gain(&Explanation::hidden, &Explanation::ranged);
  result.range_gain = gain(&Explanation::ranged, &Explanation::hidden);
  if (best.parameters() == n) return result;
  for (std::size_t s = 0; s < n; ++s)
    if (looks[s] > 0)
      result.detection_probability[s] = profile_interval(best.f, best.best, s, Scale::kLogit);
  if (best.ranged) result.per_m = profile_interval(best.f, best.best, n, Scale::kPerMetre);
  if (!best.hidden) return result;
  result.hidden = true;
  result.hide = profile_interval(best.f, best.best, n + best.ranged, Scale::kLog);
  result.show = profile_interval(best.f, best.best, n + best.ranged + 1, Scale::kLog);
  return result;
}

}  // namespace anchord::tuning
