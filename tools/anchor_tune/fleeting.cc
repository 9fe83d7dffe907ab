#include "tools/anchor_tune/fleeting.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/anchor_tune/optimum.h"

namespace anchord::tuning {
namespace {

constexpr int kRounds = 25, kBudget = 120;  // of maximisation, and evaluations in each

bool found_again(const Looks& looks) {
  return std::any_of(looks.begin(), looks.end(), [](const Glance& look) { return look.found; });
}

/// P(looks | a phantom that was just found); the forward recursion.
double likelihood(const Fleeting& f, const Looks& looks) {
  const double p = f.detection_probability.value, both = f.hide.value + f.show.value;
  const double shown = both > 0 ? f.show.value / both : 1;
  double visible = 1, hidden = 0, product = 1, seconds = -1, mixed = 1, stays = 1;
  for (const Glance& look : looks) {
    if (look.seconds != seconds) {
      seconds = look.seconds;
      mixed = std::exp(-both * seconds);
      stays = std::exp(-f.departure.value * seconds);
    }
    const double there = stays * (visible + hidden);
    visible = shown * there + mixed * (stays * visible - shown * there);
    hidden = there - visible;
    const double found = visible * p, now = look.found ? found : 1 - found;
    visible = look.found ? 1 : visible * (1 - p) / now;
    hidden = look.found ? 0 : hidden / now;
    product *= now;
  }
  return product;
}

/// Chains with the same looks are many: those that were never found again.
struct Counted {
  Looks looks;
  double count = 0;
};

std::vector<Counted> counted(const std::vector<Looks>& chains) {
  std::map<std::vector<double>, Counted> same;
  for (const Looks& looks : chains) {
    std::vector<double> key;
    for (const Glance& look : looks) key.push_back(look.found ? look.seconds : -look.seconds);
    Counted& one = same[key];
    one.looks = looks;
    ++one.count;
  }
  std::vector<Counted> out;
  for (auto& [key, one] : same) out.push_back(std::move(one));
  return out;
}

double log_likelihood_of(const FleetingKinds& all, const std::vector<Counted>& chains) {
  double sum = 0, clutter = 1;
  for (const Fleeting& f : all.kinds) clutter -= f.share.value;
  for (const Counted& chain : chains) {
    double p = found_again(chain.looks) ? 0 : clutter;
    for (const Fleeting& f : all.kinds) p += f.share.value * likelihood(f, chain.looks);
    sum += chain.count * std::log(p);
  }
  return sum;
}

/// p, departure, and hide and show where it hides, on their free scale.
std::vector<double> free_numbers(const Fleeting& f) {
  std::vector<double> x{to_free(f.detection_probability.value, Scale::kLogit),
                        std::log(f.departure.value)};
  if (f.hidden) x.insert(x.end(), {std::log(f.hide.value), std::log(f.show.value)});
  return x;
}

Fleeting with_numbers(Fleeting f, const double* x) {
  f.detection_probability.value = from_free(x[0], Scale::kLogit);
  f.departure.value = std::exp(x[1]);
  if (f.hidden) f.hide.value = std::exp(x[2]), f.show.value = std::exp(x[3]);
  return f;
}

/// One round: whose the chains are, and the most likely numbers of each kind given that.
void step(FleetingKinds& all, const std::vector<Counted>& chains) {
  double total = 0;
  std::vector<std::vector<double>> shares;
  for (const Counted& chain : chains) {
    shares.push_back(all.shares(chain.looks));
    total += chain.count;
  }
  for (std::size_t k = 0; k < all.kinds.size(); ++k) {
    Fleeting& kind = all.kinds[k];
    const auto f = [&](const std::vector<double>& x) {
      const Fleeting tried = with_numbers(kind, x.data());
      double sum = 0;
      for (std::size_t i = 0; i < chains.size(); ++i)
        if (shares[i][k] > 1e-6)
          sum += chains[i].count * shares[i][k] * std::log(likelihood(tried, chains[i].looks));
      return sum;
    };
    const Optimum best = maximise(f, free_numbers(kind), 0.3, kBudget);
    double mine = 0;
    for (std::size_t i = 0; i < chains.size(); ++i) mine += chains[i].count * shares[i][k];
    kind = with_numbers(kind, best.at.data());
    kind.share.value = mine / total;
  }
}

/// From kinds that are found more and less surely, and stay longer and less long.
FleetingKinds fit(const std::vector<Counted>& chains, int count, bool hidden, double rate) {
  FleetingKinds all;
  for (int k = 0; k < count; ++k) {
    Fleeting& f = all.kinds.emplace_back();
    f.hidden = hidden;
    f.share.value = 0.7 / count;
    f.detection_probability.value = (count - k) / (count + 0.5);
    f.departure.value = rate * (k + 1);
    if (hidden) f.hide.value = f.show.value = rate;
  }
  double before = log_likelihood_of(all, chains);
  for (int round = 0; round < kRounds; ++round) {
    step(all, chains);
    const double now = log_likelihood_of(all, chains);
    if (now - before < 0.01) break;
    before = now;
  }
  std::stable_sort(all.kinds.begin(), all.kinds.end(), [](const Fleeting& a, const Fleeting& b) {
    return a.detection_probability.value > b.detection_probability.value;
  });
  return all;
}

void add_intervals(FleetingKinds& all, const std::vector<Counted>& chains) {
  const std::size_t each = all.kinds[0].hidden ? 5 : 3;
  Optimum best;
  std::vector<Scale> scales;
  for (const Fleeting& f : all.kinds) {
    best.at.push_back(to_free(f.share.value, Scale::kLogit));
    const auto x = free_numbers(f);
    best.at.insert(best.at.end(), x.begin(), x.end());
    scales.insert(scales.end(), {Scale::kLogit, Scale::kLogit, Scale::kLog});
    if (f.hidden) scales.insert(scales.end(), {Scale::kLog, Scale::kLog});
  }
  const auto f = [&](const std::vector<double>& x) {
    FleetingKinds tried = all;
    double sum = 0;
    for (std::size_t k = 0; k < tried.kinds.size(); ++k) {
      tried.kinds[k] = with_numbers(tried.kinds[k], &x[each * k + 1]);
      sum += tried.kinds[k].share.value = from_free(x[each * k], Scale::kLogit);
    }
    return sum < 1 ? log_likelihood_of(tried, chains) : -1e9;
  };
  best.value = f(best.at);
  const auto intervals = curvature_intervals(f, best, scales);
  for (std::size_t k = 0; k < all.kinds.size(); ++k) {
    Fleeting& kind = all.kinds[k];
    kind.share = intervals[each * k];
    kind.detection_probability = intervals[each * k + 1];
    kind.departure = intervals[each * k + 2];
    if (kind.hidden) kind.hide = intervals[each * k + 3], kind.show = intervals[each * k + 4];
  }
}

}  // namespace

std::vector<double> FleetingKinds::shares(const Looks& looks) const {
  std::vector<double> out;
  double clutter = 1, sum = 0;
  for (const Fleeting& f : kinds) {
    clutter -= f.share.value;
    sum += out.emplace_back(f.share.value * likelihood(f, looks));
  }
  if (!found_again(looks)) sum += std::max(clutter, 0.0);
  for (double& p : out) p /= sum;
  return out;
}

std::optional<FleetingKinds> fit_fleeting(const std::vector<Looks>& chains, int count) {
  double looks = 0, seconds = 0;
  bool again = false;
  for (const Looks& chain : chains) {
    again = again || found_again(chain);
    for (const Glance& look : chain) ++looks, seconds += look.seconds;
  }
  if (!again || seconds <= 0) return std::nullopt;
  const auto unlike = counted(chains);
  const double rate = looks / seconds / 10;  // spells of ten looks
  FleetingKinds plain = fit(unlike, count, false, rate), hiding = fit(unlike, count, true, rate);
  const double gain = log_likelihood_of(hiding, unlike) - log_likelihood_of(plain, unlike);
  FleetingKinds& best = gain > count * std::log(looks) ? hiding : plain;
  best.gain = gain;
  add_intervals(best, unlike);
  return best;
}

}  // namespace anchord::tuning
