#include "tools/anchor_tune/from_frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "anchoring/world.h"
#include "knowledge/configuration.h"
#include "tests/anchor_tune/street.h"

namespace anchord::tuning {
namespace {

/// Few enough objects that the engine loses next to nothing by its bounds.
Street small_street() {
  Street s;
  s.side = 10;
  s.frames = 60;
  s.clutter_density = 0.02;
  s.arrival_rate = 2e-3;
  s.undetected_intensity = 0.04;
  return s;
}

std::vector<Recording> recordings(const Street& street, int count, std::uint64_t seed) {
  std::vector<Recording> all;
  for (int i = 0; i < count; ++i)
    all.push_back(simulate(street, seed + static_cast<std::uint64_t>(i)));
  return all;
}

void expect_greatest_near_the_truth(const Street& street) {
  const auto frames = recordings(street, 6, 40);
  Knowledge knowledge = knowledge_of(street);
  const double at_truth = *log_evidence(knowledge, frames);
  for (const Parameter& p : parameters_of(knowledge, {"camera"}))
    for (const double factor : {0.25, 4.0}) {
      Knowledge off = knowledge;
      const double odds = std::exp(to_free(p.start, p.scale)) * factor;
      p.set(off, p.scale == Scale::kPerMetre ? p.start * factor
                 : p.scale == Scale::kLog    ? odds
                                             : odds / (1 + odds));
      // The interval of the most uncertain of them, the departures of some forty objects, reaches
      // less than a factor of 2.
      EXPECT_GT(at_truth, *log_evidence(off, frames) + 1.92)
          << dotted(p.path) << " times " << factor;
    }
}

TEST(FromFrames, EvidenceIsGreatestNearTheTruth) { expect_greatest_near_the_truth(small_street()); }

Street seen_from_a_corner() {
  Street street = small_street();
  street.detection_probability = 0.98;
  street.per_m = -0.2;  // 0.74 at the far corner
  return street;
}

TEST(FromFrames, EvidenceIsGreatestNearTheTruthWhereDetectionFallsWithTheDistance) {
  expect_greatest_near_the_truth(seen_from_a_corner());
}

TEST(FromFrames, HowDetectionFallsIsWrittenAsItIsRead) {
  const Street street = seen_from_a_corner();
  const auto findings = findings_from_frames(recordings(street, 1, 70), knowledge_of(street), 20);
  ASSERT_TRUE(findings.ok());
  const auto read = parse_configuration(
      tuned_text(nlohmann::json::parse(configuration_of(street)), *findings, ""));
  ASSERT_TRUE(read.ok()) << read.mistakes()[0].text();
  const Knowledge knowledge = read.knowledge();
  int estimates = 0;
  for (const Finding& f : *findings) {
    const std::string at = dotted(f.path);
    if (!f.estimate || !at.starts_with("sensors.camera.detection_probability")) continue;
    ++estimates;
    const DetectionProbability& p = knowledge.sensor("camera").detection_probability[0];
    EXPECT_EQ(at.back() == '0' ? p.near : p.per_m, f.value.get<double>()) << at;
  }
  EXPECT_EQ(estimates, 2);
}

TEST(FromFrames, IntervalsHoldTheTruth) {
  const Street street = small_street();
  Street start = street;
  start.psd *= 4;
  start.velocity_variance /= 3;
  start.detection_probability = 0.7;
  start.clutter_density /= 3;
  start.arrival_rate *= 3;
  start.departure_rate *= 3;
  start.undetected_intensity /= 3;
  Knowledge begin = knowledge_of(start);
  begin.limits.max_hypotheses = 20;  // some four objects, two false detections: enough, and quick
  Knowledge truth = knowledge_of(street);
  std::map<std::string, double> numbers;
  for (const Parameter& p : parameters_of(truth, {"camera"})) numbers[dotted(p.path)] = p.start;
  int hits = 0, intervals = 0;
  for (int run = 0; run < 4; ++run) {
    const auto findings =
        findings_from_frames({simulate(street, 60 + static_cast<std::uint64_t>(run))}, begin, 250);
    ASSERT_TRUE(findings.ok());
    for (const Finding& f : *findings) {
      if (!f.estimate) continue;
      const double value = numbers.at(dotted(f.path));
      ++intervals;
      hits += f.estimate->low <= value && value <= f.estimate->high;
    }
  }
  EXPECT_EQ(intervals, 4 * 7);
  // Of 28 intervals of 95 % 26.6 are expected to hold; fewer than 23 do in one of a hundred, though
  // a run's are not independent, and curvature is not all of the likelihood.
  EXPECT_GE(hits, 23);
}

TEST(FromFrames, ScoresPutTheExpectedClutterRight) {
  // A frame of two detections that are right with 0.8 each: clutter at p = 0.5 is four times as
  // dense as clutter on the whole.
  Street street = small_street();
  street.frames = 1;
  Recording recording = simulate(street, 1);
  const Detection z = recording.frames[0].detections.at(0);
  recording.frames[0].detections = {z, z};
  const Knowledge knowledge = knowledge_of(street);
  for (Detection& d : recording.frames[0].detections) d.score = 0.8;
  World world(knowledge);
  ASSERT_TRUE(world.apply(recording.frames[0]).ok());
  const double expected = street.clutter_density * street.side * street.side;
  EXPECT_NEAR(*log_evidence(knowledge, {recording}),
              world.belief()->log_evidence + expected * (1 - 0.25), 1e-9);
}

TEST(FromFrames, WhatIsZeroStaysSo) {
  Street street = small_street();
  street.departure_rate = 0;
  Knowledge knowledge = knowledge_of(street);
  for (const Parameter& p : parameters_of(knowledge, {"camera"}))
    EXPECT_NE(dotted(p.path), "classes.object.departure_rate");
}

TEST(FromFrames, RefusesWhatTheEngineRefuses) {
  Recording recording = simulate(small_street(), 1);
  recording.frames[3].sensor.clear();
  EXPECT_FALSE(findings_from_frames({recording}, knowledge_of(small_street()), 10).ok());
}

}  // namespace
}  // namespace anchord::tuning
