#include "anchoring/reach.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "anchoring/association.h"
#include "anchoring/concern.h"
#include "tests/anchoring/random_scene.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

/// How many clusters a frame passes over. Each must be one that it would leave as it is.
int passed_over(const Belief& belief, const MapFrame& frame, const Background& background) {
  const Visibility visibility(frame, background);
  const Occlusion occlusion(belief, frame, background);
  const auto from = origins(belief, frame, background);
  Nearby nearby(frame, background);
  std::set<const Cluster*> concerned;
  belief.clusters.visit(Concern(frame, background), [&](Clusters::Place, const auto& cluster) {
    concerned.insert(cluster.get());
  });
  int passed = 0;
  for (const auto& cluster : belief.clusters) {
    if (concerned.count(cluster.get())) continue;
    ++passed;
    const Scratch scratch;
    const auto found = predict(cluster, frame, from, visibility, occlusion, nearby, background);
    EXPECT_FALSE(found.touched());
    EXPECT_FALSE(found.departed(background.knowledge.limits.min_existence));
  }
  return passed;
}

TEST(Reach, AFramePassesOverNothingThatItWouldChange) {
  std::mt19937_64 random(20140602);
  int passed = 0, checked = 0;
  for (int n = 0; n < 300; ++n) {
    auto variety = enumeration::random_variety(random);
    variety.views = true;
    variety.several_models = variety.undetectable = n % 10 == 0;  // those are always met
    auto scene = enumeration::random_scene(random, variety);
    scene.knowledge.limits = Limits{};
    scene.knowledge.limits.min_existence = n % 2 ? 1e-4 : 0.05;
    World world(scene.knowledge);
    for (const std::size_t i : scene.arrival) ASSERT_TRUE(world.apply(scene.frames[i]));
    for (Frame frame : scene.frames)
      for (const double later : {0.1, 1.0, 10.0, 100.0, 1e4}) {
        frame.utime = world.belief()->utime + from_seconds(later);
        const auto placed = world.check(frame);
        ASSERT_TRUE(placed) << placed.error().text();
        passed += passed_over(*world.belief(), *placed, *world.background());
        checked += static_cast<int>(world.belief()->clusters.size());
      }
  }
  EXPECT_GT(passed, 200);
  EXPECT_GT(checked, passed);
}

/// A field of boxes, one in each square metre, and one frame that saw them all.
struct Field {
  static constexpr int kSide = 30;
  World world{knowledge_from(R"({
    "world": {"dimensions": 2, "bounds": {"min": [0, 0], "max": [30, 30]}},
    "classes": {"default": {
      "models": [{"kind": "constant_position", "position_psd": 1e-6}],
      "undetected_intensity": 0.5, "extent": [0.3, 0.3, 0.3]}},
    "sensors": {"default": {"clutter_density": 0.001}}})")};

  Field() {
    std::vector<Detection> all;
    for (int i = 0; i < kSide * kSide; ++i) all.push_back(at(i % kSide + 0.5, i / kSide + 0.5));
    apply(world, {frame(0, all)});
  }
};

/// A frame that sees a square only.
Frame corner(double seconds, double x, double y, std::vector<Detection> detections) {
  Frame f = frame(seconds, std::move(detections));
  f.view.emplace().type = View::Type::kPolygon;
  f.view->points = {{x, y}, {x + 2, y}, {x + 2, y + 2}, {x, y + 2}};
  return f;
}

TEST(Reach, WhatIsFarFromTheViewIsNotEvenCopied) {
  Field field;
  const auto before = field.world.belief();
  ASSERT_EQ(before->clusters.size(), 900u);
  apply(field.world, {corner(1, 10, 10, {at(10.5, 10.5)})});
  const std::set<Clusters::Pointer> old(before->clusters.begin(), before->clusters.end());
  int changed = 0;
  for (const auto& cluster : field.world.belief()->clusters) changed += !old.count(cluster);
  EXPECT_EQ(changed, 4);
  EXPECT_EQ(field.world.belief()->clusters.size(), 900u);
  EXPECT_EQ(before->clusters.size(), 900u);  // a copy that others read
  const MapFrame next = *field.world.check(corner(2, 20, 5, {}));
  EXPECT_GT(passed_over(*field.world.belief(), next, *field.world.background()), 850);
}

TEST(Reach, ADetectionOutsideTheViewAndANamedObjectAreMet) {
  Field field;
  const auto id = ids(field.world).front();
  apply(field.world, {corner(1, 10, 10, {at(25.5, 25.5)})});
  EXPECT_EQ(field.world.belief()->clusters.size(), 900u);  // nothing new at 25.5
  Frame named = corner(2, 10, 10, {at(12.5, 0.5)});
  named.detections[0].object = id;
  const MapFrame placed = *field.world.check(named);
  bool met = false;
  field.world.belief()->clusters.visit(
      Concern(placed, *field.world.background()),
      [&](Clusters::Place, const auto& c) { met = met || c->anchors[0].anchor->is_called(id); });
  EXPECT_TRUE(met);
}

TEST(Clusters, HoldWhatWasPutInWhateverWasTakenOut) {
  Field field;
  const Background& background = *field.world.background();
  const auto& all = field.world.belief()->clusters;
  const std::vector<Clusters::Pointer> pool(all.begin(), all.end());
  std::mt19937_64 random(20140603);
  Clusters clusters;
  std::multiset<Clusters::Pointer> expected;
  for (int n = 0; n < 200; ++n) {
    std::vector<Clusters::Place> gone;
    const auto some = [&](const Reach&) { return true; };
    clusters.visit(some, [&](Clusters::Place place, const Clusters::Pointer& cluster) {
      if (random() % 4) return;
      gone.push_back(place);
      expected.erase(expected.find(cluster));
    });
    std::vector<Clusters::Pointer> come;
    for (auto i = random() % 80; i > 0; --i) come.push_back(pool[random() % pool.size()]);
    expected.insert(come.begin(), come.end());
    const Clusters before = clusters;
    const std::vector<Clusters::Pointer> then(before.begin(), before.end());
    clusters.exchange(gone, come, background);
    ASSERT_EQ(clusters.size(), expected.size());
    ASSERT_TRUE(std::multiset<Clusters::Pointer>(clusters.begin(), clusters.end()) == expected);
    ASSERT_TRUE(std::vector<Clusters::Pointer>(before.begin(), before.end()) == then);
    if (clusters.empty()) continue;
    const std::size_t index = random() % clusters.size();
    EXPECT_EQ(clusters[index], *std::next(clusters.begin(), static_cast<std::ptrdiff_t>(index)));
    expected.erase(expected.find(clusters[index]));
    clusters.erase(index);
    clusters.add(pool[index % pool.size()], background);
    expected.insert(pool[index % pool.size()]);
  }
}

}  // namespace
}  // namespace anchord
