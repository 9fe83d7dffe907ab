// A building full of things at rest, all of them believed in, and a robot that drives through it:
// what an update costs where 100 of 1,000, 10,000 or 100,000 anchors are in view, and what memory
// they take. Arguments: numbers of things, instead of these.

#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "anchoring/world.h"
#include "bench/building.h"
#include "bench/plaza_log.h"
#include "bench/timing.h"

namespace {

using namespace anchord;  // NOLINT: a program's own file
using bench::fixed;

constexpr int kFrames = 500, kRuns = 3;

/// What this process takes now, MB.
double resident_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmRSS:") {
      double kb = 0;
      status >> kb;
      return kb / 1024;
    }
  return 0;
}

void take(World& world, const Frame& frame) {
  if (const Status applied = world.apply(frame); !applied) {
    std::fprintf(stderr, "refused: %s\n", applied.error().text().c_str());
    std::exit(EXIT_FAILURE);
  }
}

void drive(int things, const Knowledge& classes) {
  const double before = resident_mb();
  bench::Building building(things, classes, 1);
  World world(building.knowledge());
  // Twice, as what was seen but once may be clutter.
  for (int pass = 0; pass < 2; ++pass)
    for (int room = 0; room < building.rooms(); ++room) take(world, building.inspect(room));
  std::size_t anchors = 0;
  for (const auto& cluster : world.belief()->clusters) anchors += cluster->anchors.size();
  const double memory = resident_mb() - before;
  bench::Times wall, cpu;
  std::size_t seen = 0;
  for (int step = 0; step < kRuns * kFrames; ++step) {
    const Frame frame = building.look(step);
    seen += frame.detections.size();
    const bench::Stopwatch watch;
    take(world, frame);
    cpu.add(watch.cpu_ms()), wall.add(watch.wall_ms());
  }
  bench::print_row({std::to_string(things), std::to_string(anchors),
                    fixed(static_cast<double>(seen) / (kRuns * kFrames), 1),
                    fixed(wall.median_ms(), 3), fixed(wall.p99_ms(), 3), fixed(cpu.median_ms(), 3),
                    fixed(cpu.p99_ms(), 3), fixed(memory, 0)});
}

}  // namespace

int main(int argc, char** argv) {
  const Knowledge classes = bench::read_knowledge("bench/building.json");
  bench::print_head({"things", "anchors", "detections a frame", "median ms", "p99 ms",
                     "median CPU ms", "p99 CPU ms", "MB"});
  if (argc > 1)
    for (int i = 1; i < argc; ++i) drive(std::atoi(argv[i]), classes);
  else
    for (const int things : {1'000, 10'000, 100'000}) drive(things, classes);
  return EXIT_SUCCESS;
}
