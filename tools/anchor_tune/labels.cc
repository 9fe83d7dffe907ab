#include "tools/anchor_tune/labels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace anchord::tuning {
namespace {

struct Report {
  int truth;
  std::vector<double> m;  // sums to 1
};

std::vector<Report> reports_of(const Judgement& judgement, int sensor) {
  std::vector<Report> reports;
  for (const JudgedFrame& frame : judgement.frames) {
    if (frame.sensor != sensor) continue;
    for (const Judged& z : frame.detections) {
      if (z.verdict != Verdict::kRight || !z.placed.has_class) continue;
      Report report{z.object_class, z.placed.class_ratio};
      const double sum = std::accumulate(report.m.begin(), report.m.end(), 0.0);
      for (double& p : report.m) p /= sum;
      reports.push_back(std::move(report));
    }
  }
  return reports;
}

}  // namespace

std::optional<Labels> fit_labels(const Judgement& judgement, int sensor, int classes) {
  const auto reports = reports_of(judgement, sensor);
  if (reports.empty() || classes < 2) return std::nullopt;
  const auto n = static_cast<std::size_t>(classes);
  Labels labels;
  labels.pairs = static_cast<int>(reports.size());
  labels.counts.assign(n, std::vector<int>(n, 0));
  std::vector<double> share(n, 0.0);
  for (const Report& r : reports) {
    const auto top = std::max_element(r.m.begin(), r.m.end()) - r.m.begin();
    ++labels.counts[static_cast<std::size_t>(r.truth)][static_cast<std::size_t>(top)];
    share[static_cast<std::size_t>(r.truth)] += 1.0 / labels.pairs;
  }
  for (const auto& counts : labels.counts) {
    auto& row = labels.confusion.emplace_back();
    const double all = std::accumulate(counts.begin(), counts.end(), 0.0) + 0.5 * classes;
    for (const int k : counts) row.push_back((k + 0.5) / all);
  }
  for (const Report& r : reports) {
    double sum = 0, confused_sum = 0, own = 0, confused_own = 0;
    for (std::size_t s = 0; s < n; ++s) {
      const double confused =
          std::inner_product(r.m.begin(), r.m.end(), labels.confusion[s].begin(), 0.0);
      sum += share[s] * r.m[s];
      confused_sum += share[s] * confused;
      if (static_cast<int>(s) == r.truth) own = r.m[s], confused_own = confused;
    }
    const double of_class = share[static_cast<std::size_t>(r.truth)];
    labels.loss -= std::log(of_class * own / sum) / labels.pairs;
    labels.confusion_loss -= std::log(of_class * confused_own / confused_sum) / labels.pairs;
  }
  const double penalty = classes * (classes - 1) / 2.0 * std::log(labels.pairs);
  labels.confused = labels.pairs * (labels.loss - labels.confusion_loss) > penalty;
  return labels;
}

}  // namespace anchord::tuning
