// What it costs to decide what to look at next.

#include <benchmark/benchmark.h>

#include <random>
#include <string>
#include <vector>

#include "knowledge/configuration.h"
#include "maintenance/planner.h"

namespace anchord::bench {
namespace {

/// A solid house of 20 x 15 m, in six rooms if it has walls, with a camera that sees far
/// and one that sees exactly.
Knowledge house(const std::string& planner, bool walls) {
  const std::string rooms = R"(, "walls": [
    [[0, 7], [3, 7]], [[4, 7], [10, 7]], [[11, 7], [16, 7]], [[17, 7], [20, 7]],
    [[7, 0], [7, 3]], [[7, 4], [7, 11]], [[7, 12], [7, 15]],
    [[13, 0], [13, 3]], [[13, 4], [13, 11]], [[13, 12], [13, 15]],
    [[0, 0], [20, 0]], [[20, 0], [20, 15]], [[20, 15], [0, 15]], [[0, 15], [0, 0]]])";
  return parse_configuration(R"({"world": {"bounds": {"min": [0, 0, 0], "max": [20, 15, 3]})" +
                             (walls ? rooms : "") + R"(},
    "sensors": {
      "wide": {"view": {"type": "frustum", "hfov": 1, "vfov": 0.8, "range": [0.5, 4]},
                 "noise": [0.001, 0, 0, 0, 0.001, 0, 0, 0, 0.001],
                 "verification": {"mount": {"position": [0.1, 0, 1]}, "dwell": 1}},
      "precise": {"view": {"type": "frustum", "hfov": 0.6, "vfov": 0.6, "range": [0.3, 2.5]},
                  "noise": [0.0001, 0, 0, 0, 0.0001, 0, 0, 0, 0.0001],
                  "verification": {"mount": {"position": [0.1, 0, 0.9]}, "dwell": 2}}},
    "maintenance": {"threshold": 1, "planner": ")" +
                             planner + "\"}}")
      .knowledge();
}

/// `count` objects spread over the house, each known as well as the time since its last look says.
std::vector<Subject> things(int count, const Knowledge& knowledge) {
  std::mt19937_64 random(5);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<Subject> all;
  for (int i = 0; i < count; ++i) {
    Gaussian position;
    position.mean = {20 * uniform(), 15 * uniform(), 0.6 + 0.6 * uniform()};
    position.covariance = (0.001 + 0.2 * uniform()) * Eigen::Matrix3d::Identity();
    all.push_back(
        single_subject(std::to_string(i), position, 1e-3 * uniform(), 0.95, 0, knowledge));
  }
  return all;
}

void BM_Choose(benchmark::State& state, const std::string& planner, bool walls) {
  const Knowledge knowledge = house(planner, walls);
  const Site site(knowledge);
  const std::vector<Subject> subjects = things(static_cast<int>(state.range(0)), knowledge);
  RobotPose robot;
  robot.pose.position = {2, 2, 0};
  int compared = 0;
  for (auto _ : state) {
    const auto action = choose(subjects, robot, site);
    benchmark::DoNotOptimize(action);
    compared = action ? action->considered : 0;
  }
  state.counters["compared"] = compared;
  state.counters["sensors"] = static_cast<double>(site.eyes.size());
}
BENCHMARK_CAPTURE(BM_Choose, greedy, "greedy", false)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_Choose, greedy_walls, "greedy", true)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_Choose, lookahead, "lookahead", false)
    ->Arg(100)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_Choose, lookahead_walls, "lookahead", true)
    ->Arg(100)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace anchord::bench
