// The simulations of thesis section 3.7 and beyond: one line per run, CSV, on standard output.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "experiments/maintenance/studies.h"

namespace {

using anchord::experiment::Dice;
using anchord::experiment::Outcome;
using anchord::experiment::Point;

void print_list(const std::vector<int>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) std::printf("%s%d", i ? " " : "", numbers[i]);
}

void run(const Point& point, int runs) {
  const int n = std::max(1, runs / point.runs_share);
  for (int i = 0; i < n; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    Dice dice(seed + 1'000'000);  // scenes are the same for all points
    const Outcome o = simulate(point.scene(dice), point.how, point.span, seed);
    std::printf("%s,%s,%s,%.4g,%d,%.9g,%.9g,%.9g,%d,%d,%.9g,%.9g,", point.study.c_str(),
                point.variant.c_str(), point.strategy.c_str(), point.value, i, o.h_max, o.h_sum,
                o.distance, o.actions, o.updates, o.cost, o.lost);
    print_list(o.updated);
    std::printf(",");
    print_list(o.approached);
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Simulations of world model maintenance: one line of CSV per run"};
  int runs = 250;
  std::vector<std::string> studies;
  app.add_option("--runs", runs, "per point; some studies make one of every 5 or 8")
      ->check(CLI::PositiveNumber);
  app.add_option("studies", studies, "which; all, if none is named")
      ->check(CLI::IsMember(anchord::experiment::study_names()));
  CLI11_PARSE(app, argc, argv);
  if (studies.empty()) studies = anchord::experiment::study_names();
  std::printf(
      "study,variant,strategy,value,run,h_max,h_sum,distance,actions,updates,cost,lost,updated,"
      "approached\n");
  for (const std::string& study : studies)
    for (const Point& point : anchord::experiment::points_of(study)) run(point, runs);
  return 0;
}
