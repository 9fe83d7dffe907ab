#include "mht/factors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace anchord {
namespace {

/// Sets that grow together.
class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(int a, int b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::vector<int>> all() {
    std::map<int, std::vector<int>> by_root;
    for (int i = 0; i < static_cast<int>(parent_.size()); ++i) by_root[find(i)].push_back(i);
    std::vector<std::vector<int>> out;
    for (auto& [root, members] : by_root) out.push_back(std::move(members));
    return out;
  }

 private:
  std::vector<int> parent_;
};

/// One variable over the hypotheses: for each a label, with the labels' probabilities.
struct Variable {
  std::vector<int> label;
  std::vector<double> probability;
  double minor = 0;  // all but the most probable label
};

Variable variable(const HypothesisSet& set, const std::vector<double>& weight,
                  const std::vector<int>& anchors) {
  std::map<std::vector<int>, int> labels;
  Variable v;
  std::vector<int> key(anchors.size());
  for (std::size_t h = 0; h < set.size(); ++h) {
    for (std::size_t i = 0; i < anchors.size(); ++i) key[i] = set[h].leaf[anchors[i]];
    const auto [it, is_new] = labels.try_emplace(key, static_cast<int>(labels.size()));
    if (is_new) v.probability.push_back(0);
    v.label.push_back(it->second);
    v.probability[it->second] += weight[h];
  }
  v.minor = 1 - *std::max_element(v.probability.begin(), v.probability.end());
  return v;
}

/// Total variation between the joint distribution of two variables and the product of theirs.
double dependence(const Variable& a, const Variable& b, const std::vector<double>& weight) {
  const std::size_t columns = b.probability.size();
  std::vector<double> joint(a.probability.size() * columns, 0.0);
  for (std::size_t h = 0; h < weight.size(); ++h)
    joint[a.label[h] * columns + b.label[h]] += weight[h];
  double sum = 0;
  for (std::size_t i = 0; i < a.probability.size(); ++i)
    for (std::size_t j = 0; j < columns; ++j)
      sum += std::abs(joint[i * columns + j] - a.probability[i] * b.probability[j]);
  return sum / 2;
}

/// Total variation between the set and the product of the groups' marginals.
double loss(const std::vector<Variable>& groups, const std::vector<double>& weight) {
  double difference = 0, covered = 0;
  for (std::size_t h = 0; h < weight.size(); ++h) {
    double product = 1;
    for (const auto& g : groups) product *= g.probability[g.label[h]];
    difference += std::abs(weight[h] - product);
    covered += product;
  }
  return (difference + std::max(0.0, 1 - covered)) / 2;
}

std::vector<Variable> variables(const HypothesisSet& set, const std::vector<double>& weight,
                                const std::vector<std::vector<int>>& groups) {
  std::vector<Variable> out;
  for (const auto& group : groups) out.push_back(variable(set, weight, group));
  return out;
}

}  // namespace

std::vector<std::vector<int>> factors(const HypothesisSet& set, const Independence& allowed) {
  const std::size_t anchors = set.empty() ? 0 : set[0].leaf.size();
  if (anchors == 0) return {};
  std::vector<double> weight;
  for (const auto& h : set) weight.push_back(std::exp(h.log_weight));

  Groups groups(anchors);
  while (true) {
    const auto members = groups.all();
    const auto now = variables(set, weight, members);
    if (loss(now, weight) <= allowed.whole) return members;
    // Pairs first. What only depends in larger groups shows in the loss alone, and is joined by
    // the strongest dependence that is left, or, where no pair shows any, all at once.
    double strongest = 0;
    std::size_t left = 0, right = 0;
    bool joined = false;
    for (std::size_t i = 0; i < now.size(); ++i)
      for (std::size_t j = i + 1; j < now.size(); ++j) {
        if (std::min(now[i].minor, now[j].minor) * 2 <= allowed.pair / anchors) continue;
        const double d = dependence(now[i], now[j], weight);
        if (d > allowed.pair) {
          groups.unite(members[i][0], members[j][0]);
          joined = true;
        } else if (d > strongest) {
          strongest = d, left = i, right = j;
        }
      }
    if (joined) continue;
    if (strongest > 0) {
      groups.unite(members[left][0], members[right][0]);
      continue;
    }
    int varying = -1;
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (now[i].minor <= 0) continue;
      if (varying >= 0) groups.unite(varying, members[i][0]);
      varying = members[i][0];
    }
    return groups.all();
  }
}

}  // namespace anchord
