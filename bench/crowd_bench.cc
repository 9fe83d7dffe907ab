// Like objects in a square: how long an update takes, and how often identities are confused.
// Arguments: numbers of objects, instead of those that have a target; or
//
//     crowd_bench --write OBJECTS SIDE_M SEED PREFIX
//
// which writes such a scene into files (bench/crowd_files.h).

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "anchoring/reading.h"
#include "anchoring/world.h"
#include "bench/crowd.h"
#include "bench/crowd_files.h"
#include "bench/identity.h"
#include "bench/timing.h"

namespace {

using anchord::bench::fixed;

constexpr double kRadius = 1;     // m
constexpr int kFirstCounted = 8;  // frames before it are for finding the objects
// The limits were tuned on the first few seeds: only the others tell what to expect.
constexpr int kSeeds = 23, kFewSeeds = 3;

std::vector<anchord::bench::Track> best_world(const anchord::World& world) {
  const anchord::Belief& belief = *world.belief();
  std::vector<anchord::bench::Track> tracks;
  for (const auto& object : anchord::read_objects(belief, belief.utime, 0, *world.background())) {
    if (!object.in_best) continue;
    const auto& position = anchord::position_of(object.versions[object.best].leaf).position;
    tracks.push_back({object.anchor->birth, position.head<2>()});
  }
  return tracks;
}

std::string target(int objects) {
  if (objects == 20) return "median < 0.5 ms, no switch";
  if (objects == 80) return "median < 3 ms, at most 1 switch";
  if (objects == 160) return "runs at all";
  return "";
}

anchord::bench::CrowdParameters scene_of(int objects, double side_m) {
  anchord::bench::CrowdParameters parameters;
  parameters.side_m = side_m;
  parameters.objects = objects;
  return parameters;
}

int write(int objects, double side_m, std::uint64_t seed, const std::string& prefix) {
  const anchord::bench::CrowdParameters parameters = scene_of(objects, side_m);
  const anchord::bench::Crowd crowd = anchord::bench::simulate(parameters, seed);
  if (anchord::bench::write_crowd(crowd, parameters, kFirstCounted, prefix)) return EXIT_SUCCESS;
  std::fprintf(stderr, "cannot write %s.*\n", prefix.c_str());
  return EXIT_FAILURE;
}

void run(int objects, double side_m, std::uint64_t seed) {
  const anchord::bench::CrowdParameters parameters = scene_of(objects, side_m);
  const anchord::bench::Crowd crowd = anchord::bench::simulate(parameters, seed);
  anchord::World world(anchord::bench::crowd_knowledge(parameters));
  anchord::bench::IdentityCount count(kRadius);
  anchord::bench::Times wall, cpu;
  for (std::size_t k = 0; k < crowd.frames.size(); ++k) {
    const anchord::bench::Stopwatch watch;
    const anchord::Status applied = world.apply(crowd.frames[k]);
    cpu.add(watch.cpu_ms());
    wall.add(watch.wall_ms());
    if (!applied) {
      std::fprintf(stderr, "refused: %s\n", applied.error().text().c_str());
      std::exit(EXIT_FAILURE);
    }
    if (k >= kFirstCounted) count.add(crowd.truth[k], best_world(world));
  }
  const auto percent = [&](long n) {
    return fixed(100 * static_cast<double>(n) / static_cast<double>(count.objects), 2);
  };
  anchord::bench::print_row({std::to_string(objects), fixed(side_m, 0), std::to_string(seed),
                             fixed(wall.median_ms(), 3), fixed(wall.p99_ms(), 2),
                             fixed(wall.max_ms(), 2), fixed(cpu.median_ms(), 3),
                             fixed(cpu.p99_ms(), 2), std::to_string(count.switches),
                             percent(count.misses), percent(count.strays), target(objects)});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 6 && std::string(argv[1]) == "--write")
    return write(std::atoi(argv[2]), std::atof(argv[3]), std::strtoull(argv[4], nullptr, 10),
                 argv[5]);
  const anchord::bench::CrowdParameters defaults;
  struct Scene {
    int objects;
    double side_m;
    int seeds;
  };
  // The last has the density of the first.
  std::vector<Scene> scenes{{20, defaults.side_m, kSeeds},
                            {80, defaults.side_m, kFewSeeds},
                            {160, defaults.side_m, kFewSeeds},
                            {80, 2 * defaults.side_m, kSeeds}};
  if (argc > 1) scenes.clear();
  for (int i = 1; i < argc; ++i) scenes.push_back({std::atoi(argv[i]), defaults.side_m, kSeeds});
  for (const Scene& scene : scenes)
    if (scene.objects < 1) {
      std::fprintf(stderr, "arguments: numbers of objects, each at least 1\n");
      return 2;
    }
  std::printf("%g Hz, %g s, noise %g m, p_D %g, one clutter detection per frame\n\n",
              defaults.rate_hz, defaults.duration_s, defaults.noise_deviation,
              defaults.detection_probability);
  anchord::bench::print_head({"objects", "side m", "seed", "median ms", "p99 ms", "max ms",
                              "median CPU ms", "p99 CPU ms", "switches", "missed %", "stray %",
                              "target"});
  for (const Scene& scene : scenes)
    for (int seed = 1; seed <= scene.seeds; ++seed) run(scene.objects, scene.side_m, seed);
  return EXIT_SUCCESS;
}
