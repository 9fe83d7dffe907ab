// The plaza's log through the engine: how long an update takes. Arguments: a log and a
// configuration, instead of the plaza's.

#include <cstdio>
#include <cstdlib>

#include "anchoring/world.h"
#include "bench/plaza_log.h"
#include "bench/timing.h"

namespace {

using anchord::bench::fixed;

constexpr int kRuns = 5;

}  // namespace

int main(int argc, char** argv) {
  const std::string log = argc > 1 ? argv[1] : anchord::bench::kPlazaLog;
  const std::string config = argc > 2 ? argv[2] : anchord::bench::kPlazaConfig;
  const anchord::Knowledge knowledge = anchord::bench::read_knowledge(config);
  const std::vector<anchord::Frame> frames = anchord::bench::read_log(log);
  std::size_t detections = 0;
  for (const anchord::Frame& frame : frames) detections += frame.detections.size();

  std::printf("%s: %zu frames, %zu detections, at most %d hypotheses a cluster; %d runs\n\n",
              log.c_str(), frames.size(), detections, knowledge.limits.max_hypotheses, kRuns);
  anchord::bench::print_head(
      {"run", "median ms", "p99 ms", "max ms", "median CPU ms", "p99 CPU ms"});
  anchord::bench::Times wall, cpu;
  for (int run = 1; run <= kRuns; ++run) {
    anchord::World world(knowledge);
    anchord::bench::Times run_wall, run_cpu;
    for (const anchord::Frame& frame : frames) {
      const anchord::bench::Stopwatch watch;
      const anchord::Status applied = world.apply(frame);
      const double cpu_ms = watch.cpu_ms(), wall_ms = watch.wall_ms();
      if (!applied) {
        std::fprintf(stderr, "refused: %s\n", applied.error().text().c_str());
        return EXIT_FAILURE;
      }
      run_wall.add(wall_ms), wall.add(wall_ms);
      run_cpu.add(cpu_ms), cpu.add(cpu_ms);
    }
    anchord::bench::print_row({std::to_string(run), fixed(run_wall.median_ms(), 3),
                               fixed(run_wall.p99_ms(), 3), fixed(run_wall.max_ms(), 3),
                               fixed(run_cpu.median_ms(), 3), fixed(run_cpu.p99_ms(), 3)});
  }
  anchord::bench::print_row({"all", fixed(wall.median_ms(), 3), fixed(wall.p99_ms(), 3),
                             fixed(wall.max_ms(), 3), fixed(cpu.median_ms(), 3),
                             fixed(cpu.p99_ms(), 3)});
  anchord::bench::print_row({"target", "< 1", "< 5", "", "", ""});
  return EXIT_SUCCESS;
}
