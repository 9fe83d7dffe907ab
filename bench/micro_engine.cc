// What one leaf and one frame cost.

#include <benchmark/benchmark.h>

#include <array>

#include "anchoring/association.h"
#include "anchoring/leaf.h"
#include "anchoring/visibility.h"
#include "bench/crowd.h"
#include "lcmtypes/checked_decode.h"
#include "lcmtypes/codec.h"
#include "models/kinematic.h"

namespace anchord::bench {
namespace {

/// A leaf that was found in one frame and is met in the next.
struct Meeting {
  CrowdParameters parameters;
  Background background{crowd_knowledge(parameters)};
  Crowd crowd = simulate(parameters, 1);
  MapFrame frame = place_in_map(crowd.frames[1], background).value();
  Leaf leaf =
      first_leaf(frame.detections[0], std::array{0.05}, 0.9, crowd.frames[0].utime, background);
  LeafVisibility shown = Visibility(frame, background).of(leaf, *frame.sensor, Occlusion(), 0);
};

void BM_Fit(benchmark::State& state) {
  const Meeting meeting;
  const auto& density = std::get<Kinematic>(meeting.leaf.models[0].density);
  for (auto _ : state)
    benchmark::DoNotOptimize(fit(density, meeting.frame.detections[0].position, 2));
}
BENCHMARK(BM_Fit);

void BM_LogLikelihood(benchmark::State& state) {
  const Meeting meeting;
  for (auto _ : state)
    benchmark::DoNotOptimize(log_likelihood(meeting.leaf, meeting.frame.detections[0],
                                            meeting.shown, true, meeting.background));
}
BENCHMARK(BM_LogLikelihood);

void BM_PredictLeaf(benchmark::State& state) {
  const Meeting meeting;
  for (auto _ : state) {
    Leaf leaf = meeting.leaf;
    predict(leaf, meeting.frame.utime, meeting.background);
    benchmark::DoNotOptimize(leaf);
  }
}
BENCHMARK(BM_PredictLeaf);

void BM_GiveLeaf(benchmark::State& state) {
  const Meeting meeting;
  for (auto _ : state) {
    Leaf leaf = meeting.leaf;
    give(leaf, meeting.frame.detections[0], meeting.shown, *meeting.frame.sensor,
         meeting.background);
    benchmark::DoNotOptimize(leaf);
  }
}
BENCHMARK(BM_GiveLeaf);

void BM_PlaceInMap(benchmark::State& state) {
  const Meeting meeting;
  for (auto _ : state)
    benchmark::DoNotOptimize(place_in_map(meeting.crowd.frames[1], meeting.background));
  state.counters["detections"] = static_cast<double>(meeting.frame.detections.size());
}
BENCHMARK(BM_PlaceInMap);

void BM_EncodeFrame(benchmark::State& state) {
  const Meeting meeting;
  for (auto _ : state) benchmark::DoNotOptimize(encode(meeting.crowd.frames[1], 1));
  state.counters["detections"] = static_cast<double>(meeting.frame.detections.size());
}
BENCHMARK(BM_EncodeFrame);

void BM_DecodeFrame(benchmark::State& state) {
  const Meeting meeting;
  const auto bytes = encode(meeting.crowd.frames[1], 1);
  for (auto _ : state) benchmark::DoNotOptimize(decode_frame(bytes));
  state.counters["detections"] = static_cast<double>(meeting.frame.detections.size());
}
BENCHMARK(BM_DecodeFrame);

}  // namespace
}  // namespace anchord::bench
