#include "anchoring/occlusion.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "anchoring/reading.h"
#include "tests/anchoring/dice.h"
#include "tests/anchoring/small_events.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

using enumeration::Dice;

/// A room of 20 x 20 (x 4) m with boxes; whatever is reported is a box.
Knowledge room(int dims, const Eigen::Vector3d& extent) {
  const std::string size = std::to_string(extent.x()) + "," + std::to_string(extent.y()) + "," +
                           std::to_string(extent.z());
  return knowledge_from(R"({"world": {"dimensions": )" + std::to_string(dims) +
                        R"(, "bounds": {"min": [-10, -10)" + (dims == 3 ? ", -2" : "") +
                        R"(], "max": [10, 10)" + (dims == 3 ? ", 2" : "") + R"(]}},
          "classes": {"object": {"models": [{"kind": "constant_position", "position_psd": 0}],
                      "undetected_intensity": 1000, "extent": [)" +
                        size + R"(]}},
          "hypotheses": {"max": 1, "gate_probability": 0.5, "scan_depth": 0}})");
}

Frame posed(double seconds, const Eigen::Vector3d& eye, std::vector<Detection> detections = {}) {
  Frame out = frame(seconds, std::move(detections));
  out.view.emplace().type = View::Type::kWorld;
  out.pose.emplace();
  out.pose->position = {eye.x(), eye.y(), eye.z()};
  return out;
}

Detection box_at(const Gaussian& position, int dims, std::optional<double> yaw = {}) {
  const auto mean = position.mean.head(dims);
  const Eigen::MatrixXd covariance = position.covariance.topLeftCorner(dims, dims);
  Detection z;
  z.measurement = CartesianMeasurement{{mean.begin(), mean.end()},
                                       {covariance.data(), covariance.data() + covariance.size()}};
  z.yaw = yaw;
  return z;
}

/// What is hidden from an eye once these boxes were reported.
Occlusion occlusion_of(const Knowledge& knowledge, const std::vector<Detection>& boxes,
                       const Eigen::Vector3d& eye) {
  World world(knowledge);
  Frame seen = frame(0, boxes);
  seen.view.emplace().type = View::Type::kWorld;
  apply(world, {seen});
  EXPECT_EQ(objects(world).size(), boxes.size());
  const auto next = place_in_map(posed(1, eye), *world.background());
  return Occlusion(*world.belief(), *next, *world.background());
}

Gaussian random_density(Dice& dice, int dims, double least, double most) {
  Gaussian out;
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
  for (int i = 0; i < dims; ++i) {
    out.mean[i] = dice.uniform(-8, 8) * (i == 2 ? 0.1 : 1);
    root(i, i) = dice.scale(least, most);
    for (int j = 0; j < i; ++j) root(i, j) = dice.uniform(-0.5, 0.5) * root(i, i);
  }
  out.covariance = root * root.transpose();
  return out;
}

/// The Cholesky factor of the first `dims` axes.
Eigen::Matrix3d root_of(const Gaussian& density, int dims) {
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
  root.topLeftCorner(dims, dims) =
      Eigen::MatrixXd(density.covariance.topLeftCorner(dims, dims)).llt().matrixL();
  return root;
}

/// Where the straight line from `eye` to `point` (0 to 1) leaves the shape; below 0: it passes by.
double leaves(const Eigen::Vector3d& eye, const Eigen::Vector3d& point,
              const Eigen::Vector3d& centre, const Eigen::Vector3d& extent,
              const std::optional<double>& yaw, int dims) {
  double from = -1e9, to = 1e9;
  const auto slab = [&](double start, double step, double half) {
    if (step == 0) {
      if (std::abs(start) > half) to = -1;
      return;
    }
    from = std::max(from, (-std::copysign(half, step) - start) / step);
    to = std::min(to, (std::copysign(half, step) - start) / step);
  };
  const Eigen::Vector3d a = eye - centre, d = point - eye;
  if (yaw) {
    const double c = std::cos(*yaw), s = std::sin(*yaw);
    slab(c * a.x() + s * a.y(), c * d.x() + s * d.y(), 0.5 * extent.x());
    slab(c * a.y() - s * a.x(), c * d.y() - s * d.x(), 0.5 * extent.y());
  } else {
    const double r = 0.5 * std::max(extent.x(), extent.y());
    const double dd = d.head<2>().squaredNorm(), ad = a.head<2>().dot(d.head<2>());
    const double root = ad * ad - dd * (a.head<2>().squaredNorm() - r * r);
    if (root < 0) return -1;
    from = (-ad - std::sqrt(root)) / dd;
    to = (-ad + std::sqrt(root)) / dd;
  }
  if (dims == 3) slab(a.z(), d.z(), 0.5 * extent.z());
  return from <= to ? to : -1;
}

TEST(Occlusion, IsTheShareOfSampledRaysThatABodyCuts) {
  std::mt19937_64 random(4);
  Dice dice(random);
  double sum = 0;
  int partly = 0, scenes = 0;
  for (int n = 0; n < 300; ++n) {
    const int dims = dice.integer(2, 3);
    const Eigen::Vector3d extent(dice.uniform(0.3, 2), dice.uniform(0.3, 2), dice.uniform(0.3, 2));
    const std::optional<double> yaw =
        dice.chance(0.5) ? std::optional(dice.uniform(-3, 3)) : std::nullopt;
    Gaussian body = random_density(dice, dims, 0.05, 0.4);
    Gaussian target = random_density(dice, dims, 0.05, 0.4);
    const Eigen::Vector3d eye = random_density(dice, dims, 0.1, 0.1).mean;
    // In front of the target, or beside it.
    body.mean =
        eye + dice.uniform(0.3, 0.8) * (target.mean - eye) + dice.scale(0.01, 2) * (body.mean / 8);
    if ((body.mean - eye).norm() < 2) continue;  // the eye in or at the body
    const Occlusion occlusion = occlusion_of(room(dims, extent), {box_at(body, dims, yaw)}, eye);
    const double clear = occlusion.clear(target, 0);
    EXPECT_EQ(occlusion.clear(target, 1), 1) << "itself";
    int hidden = 0;
    constexpr int kRays = 4000;
    const Eigen::Matrix3d body_root = root_of(body, dims), target_root = root_of(target, dims);
    for (int i = 0; i < kRays; ++i) {
      const Eigen::Vector3d a(dice.normal(), dice.normal(), dice.normal());
      const Eigen::Vector3d b(dice.normal(), dice.normal(), dice.normal());
      const double to =
          leaves(eye, target.mean + target_root * a, body.mean + body_root * b, extent, yaw, dims);
      hidden += to > 0 && to < 1;
    }
    const double sampled = 1 - static_cast<double>(hidden) / kRays;
    partly += sampled > 0.05 && sampled < 0.95;
    ++scenes;
    sum += std::abs(clear - sampled);
    // Outlines are boxes, and errors along and across count as independent: 0.16 where the line of
    // sight grazes an edge. 4000 samples add 0.008 each way, one in three times.
    EXPECT_NEAR(clear, sampled, 0.2) << "scene " << n;
  }
  EXPECT_GT(partly, 50);
  EXPECT_LT(sum / scenes, 0.02);
}

TEST(Occlusion, OfManyIsTheProductOverEach) {
  std::mt19937_64 random(5);
  Dice dice(random);
  const Eigen::Vector3d extent(0.8, 0.5, 0.7);
  for (const int dims : {2, 3}) {
    const Knowledge knowledge = room(dims, extent);
    const Eigen::Vector3d eye(0.1, 0.2, dims == 3 ? 1 : 0);
    std::vector<Detection> boxes;
    std::vector<Occlusion> alone;
    for (int i = 0; i < 40; ++i) {
      boxes.push_back(box_at(random_density(dice, dims, 0.02, 0.3), dims));
      alone.push_back(occlusion_of(knowledge, {boxes.back()}, eye));
    }
    const Occlusion all = occlusion_of(knowledge, boxes, eye);
    int hidden = 0;
    for (int n = 0; n < 300; ++n) {
      const Gaussian target = random_density(dice, dims, 0.01, 2);
      double product = 1;
      for (const Occlusion& one : alone) product *= one.clear(target, 0);
      // Forty tails of 6e-7 on either side.
      ASSERT_NEAR(all.clear(target, 0), product, 1e-4);
      hidden += product < 0.5;
    }
    EXPECT_GT(hidden, 20);
  }
}

TEST(Occlusion, HidesNothingWithoutAnEyeOrAnExtent) {
  const Gaussian box{{2, 0, 0}, Eigen::Vector3d(0.01, 0.01, 0).asDiagonal()};
  const Gaussian target{{4, 0, 0}, box.covariance};
  EXPECT_LT(occlusion_of(room(2, {1, 1, 1}), {box_at(box, 2)}, {0, 0, 0}).clear(target, 0), 0.01);
  EXPECT_TRUE(occlusion_of(room(2, {0, 0, 0}), {box_at(box, 2)}, {0, 0, 0}).none());
  World world(room(2, {1, 1, 1}));
  apply(world, {frame(0, {box_at(box, 2)})});
  const auto next = place_in_map(frame(1, {}), *world.background());
  EXPECT_TRUE(Occlusion(*world.belief(), *next, *world.background()).none());
}

/// Boxes hide cups.
constexpr const char* kBoxesHide = R"({"classes": {"default": {"departure_rate": 1e-3},
                                                   "box": {"extent": [0.6, 0.6, 0.5]}}})";
constexpr const char* kNothingHides = R"({"classes": {"default": {"departure_rate": 1e-3}}})";

Detection cup(double x, double y) { return at(x, y, "class", "cup", 0.99); }
Detection box(double x, double y) { return at(x, y, "class", "box", 0.99); }

/// Seen all at once from above, then a hundred times from the left with the box alone, then from
/// above with all that is left: a cup behind the box, and one in the open.
World told(const std::string& configuration) {
  World world(small_world(configuration));
  Frame first = frame(0, {cup(5, 2), cup(5, 3.5), box(3, 2)});
  apply(world, {first});
  first.utime = at_second(0.5);
  apply(world, {first});
  for (int i = 1; i <= 100; ++i) apply(world, {posed(i, {1, 2, 0}, {box(2, 0)})});
  return world;
}

TEST(Occlusion, WhatIsHiddenIsNotMissed) {
  World world = told(kBoxesHide);
  EXPECT_GT(find(world, "cup-1").p, 0.9) << "behind the box: it may have left, exp(-0.1)";
  for (const auto& object : objects(world)) {
    if (object.anchor->id() == "cup-2") {
      EXPECT_LT(object.p, 1e-6) << "in the open";
    }
  }
  apply(world, {frame(101, {cup(5, 2), box(3, 2)})});
  EXPECT_GT(find(world, "cup-1").p, 0.999);
  EXPECT_EQ(find(world, "cup-1").last_seen(), at_second(101)) << "it came back as itself";
}

TEST(Occlusion, WithoutExtentsItWouldBeMissed) {
  const World world = told(kNothingHides);
  for (const auto& object : objects(world)) {
    if (object.anchor->id() == "cup-1") {
      EXPECT_LT(object.p, 1e-6);
    }
  }
}

TEST(Occlusion, NothingChangesWithoutExtentsAndWallsOrWithoutAPose) {
  // The same frames, from an eye at the origin and from nowhere.
  const auto text = [](const std::string& configuration, bool with_pose) {
    World world(small_world(configuration));
    for (int i = 0; i < 20; ++i) {
      const bool both = i % 3 == 0;
      const double x = both && with_pose ? 4 : 0;  // (4, 4) is seen from beyond the wall
      Frame f = posed(i, {x, 0, 0}, {cup(2 - x, 2), cup(4 - x, 4)});
      f.detections.resize(both ? 2 : 1);
      if (!with_pose) f.pose.reset();
      apply(world, {f});
    }
    std::string out;
    for (const auto& object : objects(world)) {
      const Gaussian density = object.moments(*world.background());
      out.append(reinterpret_cast<const char*>(&object.p), sizeof object.p);
      out.append(reinterpret_cast<const char*>(density.mean.data()), sizeof density.mean);
    }
    return out;
  };
  const std::string bare = text(kNothingHides, false);
  EXPECT_EQ(text(kNothingHides, true), bare);
  const std::string shapes =
      R"({"classes": {"default": {"departure_rate": 1e-3}, "cup": {"extent": [0.5, 0.5, 0.5]}}})";
  EXPECT_EQ(text(shapes, false), bare);
  EXPECT_NE(text(shapes, true), bare);
  const std::string walls = R"({"classes": {"default": {"departure_rate": 1e-3}},
                                "world": {"walls": [[[3, 0], [3, 4]]]}})";
  EXPECT_EQ(text(walls, false), bare);
  EXPECT_NE(text(walls, true), bare);
}

TEST(Occlusion, AWallHidesObjectsPlacesAndTheUnknown) {
  // Between kitchen and hall; the cup may be lost in the hall.
  const std::string classes = R"("classes": {"cup": {"models": [
      {"kind": "constant_position", "position_psd": 0},
      {"kind": "somewhere", "place": "hall", "rate": 0.5}]}})";
  World walled(small_world(R"({"world": {"walls": [[[3, -1], [3, 5]]]}, )" + classes + "}"));
  World open(small_world("{" + classes + "}"));
  for (World* world : {&walled, &open}) {
    apply(*world, {frame(0, {cup(4.5, 2)})});
    for (int i = 1; i <= 50; ++i) apply(*world, {posed(i, {1, 2, 0})});
  }
  EXPECT_GT(find(walled, "cup-1").p, 0.9);
  EXPECT_LT(objects(open).empty() ? 0 : objects(open).front().p, 1e-6);
  const Background& background = *walled.background();
  const auto unseen = [&](const World& world, const char* place) {
    return undetected(*world.belief(), world.belief()->utime, {},
                      background.knowledge.find_place(place), background);
  };
  // 0.01 per m^2 of each of two classes over 12 m^2; one look at all of it left a tenth.
  EXPECT_LT(unseen(walled, "kitchen"), 1e-6);
  // The hall's first of twelve columns of cells is half in sight, up to 0.1 m behind the wall, and
  // empties over fifty looks.
  EXPECT_NEAR(unseen(walled, "hall"), 0.024 * 11 / 12, 1e-9);
  EXPECT_LT(unseen(open, "hall"), 1e-6);
}

TEST(Occlusion, APartOfADensityIsBehindAWall) {
  // A cup within 0.5 m of (4, 2), seen from (1, 2): what lies above y = 2 + 0.25 (x - 1) / 2 is
  // behind the wall's shadow, that begins at (3, 2.25).
  const Knowledge knowledge = small_world(R"({"world": {"walls": [[[3, 2.25], [3, 9]]]}})");
  World world(knowledge);
  apply(world, {frame(0, {at(4, 2, 0.25)})});
  const Background& background = *world.background();
  const auto next = place_in_map(posed(1, {1, 2, 0}), background);
  const Visibility visibility(*next, background);
  const Leaf& leaf = *world.belief()->clusters[0]->anchors[0].leaves[0];
  const LeafVisibility shown = visibility.of(leaf, *next->sensor, {}, 0);
  std::mt19937_64 random(3);
  Dice dice(random);
  int clear = 0;
  constexpr int kSamples = 100000;
  for (int i = 0; i < kSamples; ++i)
    clear +=
        !background.walls.hide({1, 2, 0}, {4 + 0.5 * dice.normal(), 2 + 0.5 * dice.normal(), 0});
  // Seven points across: each stands for a seventh.
  EXPECT_NEAR(shown.v, static_cast<double>(clear) / kSamples, 1.0 / 14 + 0.01);
  EXPECT_LT(shown.v, 0.85);
  EXPECT_GT(shown.v, 0.6);
}

}  // namespace
}  // namespace anchord
