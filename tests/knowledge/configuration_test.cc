#include "knowledge/configuration.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

namespace anchord {
namespace {

namespace fs = std::filesystem;

const std::string kWorld = R"("world": {"bounds": {"min": [0, 0, 0], "max": [10, 8, 3]}})";
const std::string kParts = kWorld + R"(,
  "places": [{"name": "table", "kind": "surface", "parent": "kitchen", "z": [0.6, 1.1],
              "polygon": [[1, 1], [2, 1], [2, 2], [1, 2]]},
             {"name": "kitchen", "polygon": [[0, 0], [4, 0], [4, 3], [0, 3]]}],
  "attributes": {
    "class": {"kind": "categorical", "symbols": ["cup", "box", "ant"]},
    "size": {"kind": "scalar", "unit": "m",
             "predicates": {"large": [0.25, null], "medium": [0.15, 0.25], "small": [0, 0.15]}}})";

std::string all_text(const Configuration& configuration) {
  std::string text;
  for (const ConfigurationMistake& mistake : configuration.mistakes()) {
    text += mistake.text() + "\n";
  }
  return text;
}

Knowledge knowledge_of(const Configuration& configuration) {
  EXPECT_TRUE(configuration.ok()) << all_text(configuration);
  return configuration.ok() ? configuration.knowledge() : Knowledge{};
}

/// The usual parts and `more` (such as `"classes": {...}`).
Knowledge with(const std::string& more) {
  return knowledge_of(parse_configuration("{" + kParts + (more.empty() ? "" : "," + more) + "}"));
}

TEST(Configuration, WithoutAnythingButBoundsHasTheDocumentedDefaults) {
  const Knowledge knowledge = knowledge_of(parse_configuration("{" + kWorld + "}"));
  EXPECT_EQ(knowledge.map_frame, "map");
  EXPECT_EQ(knowledge.dims, 3);
  EXPECT_EQ(knowledge.bounds_max, Eigen::Vector3d(10, 8, 3));
  EXPECT_EQ(knowledge.cell, 0.25);
  EXPECT_EQ(knowledge.max_lateness, 0.5);
  EXPECT_EQ(knowledge.max_leap, 600);
  EXPECT_EQ(knowledge.class_attribute, -1);
  ASSERT_EQ(knowledge.classes.size(), 1u);
  const ObjectClass& object = knowledge.classes[0];
  EXPECT_EQ(object.name, "object");
  EXPECT_EQ(object.detection_probability, 0.9);
  EXPECT_EQ(object.undetected_intensity, 0.01);
  // Arrivals keep the intensity up: lambda = beta / mu.
  EXPECT_EQ(object.departure_rate, 0);
  ASSERT_EQ(object.models.size(), 2u);
  EXPECT_EQ(object.models[0].kind, BehaviourModel::Kind::kConstantVelocity);
  EXPECT_EQ(object.models[0].psd, 0.1);
  EXPECT_EQ(object.models[0].initial_velocity_variance, 0.01);
  EXPECT_EQ(object.models[0].initial_weight, 1);
  EXPECT_EQ(object.models[1].kind, BehaviourModel::Kind::kSomewhere);
  EXPECT_EQ(object.models[1].place, -1);
  EXPECT_EQ(object.models[1].rate, 0.001);
  EXPECT_EQ(knowledge.default_sensor.clutter_density, 1e-3);
  EXPECT_EQ(knowledge.default_sensor.detection_probability, std::vector<DetectionProbability>{0.9});
  EXPECT_FALSE(knowledge.default_sensor.view);
  EXPECT_TRUE(knowledge.default_sensor.noise.empty());
  EXPECT_EQ(knowledge.limits.max_hypotheses, 100);
}

TEST(Configuration, WithoutClassesTheOnlyClassTakesTheDefaultsParameters) {
  for (const char* name : {"default", "object"}) {
    const Knowledge knowledge = knowledge_of(parse_configuration(
        "{" + kWorld + R"(, "classes": {")" + name + R"(": {"detection_probability": 0.4}}})"));
    ASSERT_EQ(knowledge.classes.size(), 1u);
    EXPECT_EQ(knowledge.classes[0].name, "object");
    EXPECT_EQ(knowledge.classes[0].detection_probability, 0.4);
  }
}

TEST(Configuration, LimitsMayAllBeOff) {
  const Limits limits = with(R"("hypotheses": {"max": 0, "min_weight": 0, "gate_probability": 1,
                                               "scan_depth": 0, "min_existence": 0})")
                            .limits;
  EXPECT_EQ(limits.max_hypotheses, 0);
  EXPECT_EQ(limits.min_weight, 0);
  EXPECT_EQ(limits.gate_probability, 1);
  EXPECT_EQ(limits.scan_depth, 0);
  EXPECT_EQ(limits.min_existence, 0);
}

TEST(Configuration, PlacesKnowTheirParentsDepthsAndHeights) {
  const Knowledge knowledge = with("");
  ASSERT_EQ(knowledge.places.size(), 2u);
  EXPECT_EQ(knowledge.places[0].kind, "surface");
  EXPECT_EQ(knowledge.places[0].parent, 1);
  EXPECT_EQ(knowledge.places[0].depth, 1);
  EXPECT_EQ(knowledge.places[0].region.z_max, 1.1);
  EXPECT_EQ(knowledge.places[1].parent, -1);
  EXPECT_EQ(knowledge.places[1].depth, 0);
  EXPECT_EQ(knowledge.places[1].region.z_min, 0);  // the world's
  EXPECT_EQ(knowledge.places[1].region.z_max, 3);
  EXPECT_EQ(knowledge.places[1].region.area(), 12);  // 4 x 3
}

TEST(Configuration, WallsMayHaveHeights) {
  const Knowledge knowledge = knowledge_of(parse_configuration(
      R"({"world": {"bounds": {"min": [0, 0, 0], "max": [9, 9, 3]},
          "walls": [[[1, 2], [3, 4]], {"line": [[5, 6], [7, 8]], "z": [0, 1.5]}]}})"));
  ASSERT_EQ(knowledge.walls.size(), 2u);
  EXPECT_EQ(knowledge.walls[0], (Wall{{1, 2}, {3, 4}}));
  EXPECT_EQ(knowledge.walls[1], (Wall{{5, 6}, {7, 8}, 0, 1.5}));
}

TEST(Configuration, PredicatesAreInOrderAndSetTheReferenceDensity) {
  const Knowledge knowledge = with("");
  const Attribute& size =
      knowledge.attributes[static_cast<std::size_t>(knowledge.find_attribute("size"))];
  ASSERT_EQ(size.predicates.size(), 3u);
  EXPECT_EQ(size.predicates[0].name, "small");
  EXPECT_EQ(size.predicates[2].name, "large");
  EXPECT_EQ(size.predicates[2].max, std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(size.reference_density, 4);  // 1 / (0.25 - 0)
  EXPECT_EQ(size.unit, "m");
}

TEST(Configuration, ClassesTakeWhatIsMissingFromDefault) {
  const Knowledge knowledge = with(R"("classes": {
    "default": {"detection_probability": 0.7, "departure_rate": 0.25, "extent": [1, 2, 3],
                "models": [{"kind": "constant_position", "position_psd": 2},
                           {"kind": "constant_velocity"}],
                "transitions": [{"from": 0, "to": 1, "rate": 0.2}],
                "arrivals": [{"place": "table", "rate": 0.1}]},
    "cup": {"departure_rate": 0.5},
    "box": {"models": [{"kind": "somewhere", "place": "kitchen", "rate": 0.3, "stir": 0.02, "found_in": 1},
                       {"kind": "constant_position"},
                       {"kind": "constant_velocity", "initial_weight": 3, "detectable": false}],
            "transitions": [], "arrivals": []}})");
  ASSERT_EQ(knowledge.classes.size(), 3u);
  const ObjectClass &cup = knowledge.classes[0], &box = knowledge.classes[1];
  EXPECT_EQ(cup.name, "cup");
  EXPECT_EQ(cup.detection_probability, 0.7);
  EXPECT_EQ(cup.departure_rate, 0.5);
  EXPECT_EQ(cup.arrival_rate, 1e-4);  // built in
  EXPECT_EQ(cup.extent, Eigen::Vector3d(1, 2, 3));
  ASSERT_EQ(cup.models.size(), 2u);
  EXPECT_EQ(cup.models[0].psd, 2);
  EXPECT_EQ(cup.models[0].initial_weight, 1);
  EXPECT_EQ(cup.models[1].initial_weight, 0);
  ASSERT_EQ(cup.transitions.size(), 1u);
  EXPECT_EQ(cup.transitions[0].rate, 0.2);
  ASSERT_EQ(cup.arrivals.size(), 1u);
  EXPECT_EQ(cup.arrivals[0].place, knowledge.find_place("table"));

  EXPECT_EQ(box.departure_rate, 0.25);
  ASSERT_EQ(box.models.size(), 3u);
  EXPECT_EQ(box.models[0].place, knowledge.find_place("kitchen"));
  EXPECT_EQ(box.models[0].initial_weight, 0);
  EXPECT_EQ(box.models[0].found_in, 1);
  EXPECT_EQ(box.models[0].stir, 0.02);
  EXPECT_EQ(box.models[1].initial_weight, 0.25);  // 1 of 4
  EXPECT_EQ(box.models[2].initial_weight, 0.75);
  EXPECT_FALSE(box.models[2].detectable);
  EXPECT_TRUE(box.transitions.empty());
  EXPECT_TRUE(box.arrivals.empty());
  EXPECT_EQ(knowledge.classes[2].departure_rate, 0.25);  // not named at all
}

TEST(Configuration, AttributesChangeAtTheRatesOfAClass) {
  const Knowledge knowledge = knowledge_of(parse_configuration(R"({
    "world": {"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}},
    "attributes": {"class": {"kind": "categorical", "symbols": ["banana", "candle"]},
                   "color": {"kind": "categorical", "symbols": ["green", "yellow", "brown"]},
                   "size": {"kind": "scalar"}},
    "classes": {"default": {"changes": {"color": {"redraw": 0.5}, "size": {"drift": 0.25}}},
                "banana": {"changes": {"color": {"transitions": [
                    {"from": "green", "to": "yellow", "rate": 0.125}]}}}}})"));
  const ObjectClass &banana = knowledge.classes[0], &candle = knowledge.classes[1];
  ASSERT_EQ(banana.changes.size(), 1u);
  EXPECT_EQ(banana.changes[0].attribute, knowledge.find_attribute("color"));
  EXPECT_EQ(banana.changes[0].redraw, 0);
  ASSERT_EQ(banana.changes[0].transitions.size(), 1u);
  EXPECT_EQ(banana.changes[0].transitions[0].from, 0);
  EXPECT_EQ(banana.changes[0].transitions[0].to, 1);
  EXPECT_EQ(banana.changes[0].transitions[0].rate, 0.125);
  ASSERT_EQ(candle.changes.size(), 2u);
  EXPECT_EQ(candle.changes[0].redraw, 0.5);
  EXPECT_EQ(candle.changes[1].attribute, knowledge.find_attribute("size"));
  EXPECT_EQ(candle.changes[1].drift, 0.25);
}

TEST(Configuration, ObjectsMayShareDetectionsAndSensorsReportTwice) {
  const Knowledge knowledge = with(R"(
    "classes": {"default": {"models": [
        {"kind": "constant_position", "position_psd": 0.01},
        {"kind": "constant_position", "position_psd": 0.02,
         "shared_detection": {"reach": 0.5, "stir": 0.25, "size": "size"}}]}},
    "sensors": {"default": {"double_detection": 0.125}, "eye": {}})");
  const auto& models = knowledge.classes[0].models;
  EXPECT_FALSE(models[0].shares());
  ASSERT_TRUE(models[1].shares());
  EXPECT_EQ(models[1].shared_probability, 0.99);
  EXPECT_EQ(models[1].reach, 0.5);
  EXPECT_EQ(models[1].stir, 0.25);
  EXPECT_EQ(models[1].growing, knowledge.find_attribute("size"));
  EXPECT_EQ(knowledge.sensor("eye").double_detection, 0.125);
  EXPECT_EQ(with("").sensor("eye").double_detection, 0);
}

TEST(Configuration, AFramesTimeIsNotBoundedUnlessItIsSaid) {
  EXPECT_EQ(with("").limits.frame_budget, 0);
  EXPECT_EQ(with(R"("hypotheses": {"frame_budget": 0.005})").limits.frame_budget, 0.005);
}

TEST(Configuration, NoSymbolIsRuledOutUnlessTheEngineIsExact) {
  EXPECT_EQ(with("").limits.min_symbol, 1e-6);
  EXPECT_EQ(with(R"("hypotheses": {"min_weight": 1e-3})").limits.min_symbol, 1e-6);
  EXPECT_EQ(with(R"("hypotheses": {"min_weight": 0})").limits.min_symbol, 0);
  EXPECT_EQ(with(R"("hypotheses": {"min_weight": 0, "min_symbol": 0.01})").limits.min_symbol, 0.01);
}

TEST(Configuration, DetectionProbabilityFallsBackFromSensorToClass) {
  const Knowledge knowledge = with(R"(
    "classes": {"default": {"detection_probability": 0.1}, "ant": {"detection_probability": 0.2}},
    "sensors": {"default": {"detection_probability": {"box": 0.3}},
                "a": {},
                "b": {"detection_probability": {"cup": 0.4}},
                "c": {"detection_probability": {"cup": 0.5, "default": 0.6}},
                "d": {"detection_probability": 0.7}})");
  using P = std::vector<DetectionProbability>;  // of cup, box, ant
  EXPECT_EQ(knowledge.default_sensor.detection_probability, (P{0.1, 0.3, 0.2}));
  EXPECT_EQ(knowledge.sensor("unknown").detection_probability, (P{0.1, 0.3, 0.2}));
  EXPECT_EQ(knowledge.sensor("a").detection_probability, (P{0.1, 0.3, 0.2}));
  EXPECT_EQ(knowledge.sensor("b").detection_probability, (P{0.4, 0.3, 0.2}));
  EXPECT_EQ(knowledge.sensor("c").detection_probability, (P{0.5, 0.6, 0.6}));
  EXPECT_EQ(knowledge.sensor("d").detection_probability, (P{0.7, 0.7, 0.7}));
}

TEST(Configuration, SensorsTakeWhatIsMissingFromDefault) {
  const Knowledge knowledge = with(R"("sensors": {
    "default": {"clutter_density": 0.5, "noise": {"polar": [1, 2, 3]}, "pose_floor": 0.1,
                "view": {"type": "sector", "range": [0, 5], "bearing": [-1, 1]}},
    "a": {"noise": [1, 0, 0, 0, 2, 0, 0, 0, 3], "identity_doubt": 0.1,
          "score_calibration": [-0.5, 0.8]},
    "b": {"view": {"type": "frustum", "range": [0.5, 4], "hfov": 1, "vfov": 0.7}},
    "c": {"view": {"type": "polygon", "points": [[0, 0], [1, 0], [1, 1]]}}})");
  const Sensor &a = knowledge.sensor("a"), &b = knowledge.sensor("b"), &c = knowledge.sensor("c");
  EXPECT_EQ(a.name, "a");
  EXPECT_EQ(a.clutter_density, 0.5);
  EXPECT_EQ(a.noise, (std::vector<double>{1, 0, 0, 0, 2, 0, 0, 0, 3}));
  EXPECT_EQ(a.polar_noise, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(a.identity_doubt, 0.1);
  EXPECT_EQ(b.identity_doubt, 0.01);
  EXPECT_EQ(a.score_calibration.rest.a, -0.5);
  EXPECT_EQ(a.score_calibration.rest.b, 0.8);
  EXPECT_EQ(b.score_calibration.rest.b, 1);
  ASSERT_TRUE(a.view && b.view && c.view);
  EXPECT_EQ(a.view->type, View::Type::kSector);
  EXPECT_EQ(a.view->bearing, (std::array<double, 2>{-1, 1}));
  EXPECT_EQ(a.view->elevation, View{}.elevation);  // all of it
  EXPECT_EQ(b.view->type, View::Type::kFrustum);
  EXPECT_EQ(b.view->vfov, 0.7);
  EXPECT_EQ(c.view->points.size(), 3u);
  EXPECT_EQ(c.pose_floor, 0.1);
}

TEST(Configuration, DistributionsAreFilledUp) {
  const Knowledge knowledge = with(R"("sensors": {"a": {
    "prior": {"class": {"cup": 0.5}},
    "confusion": {"class": {"cup": {"cup": 0.8}, "box": {"cup": 0.2, "box": 0.2, "ant": 0}}}}})");
  const auto a = static_cast<std::size_t>(knowledge.class_attribute);
  EXPECT_EQ(knowledge.sensor("a").prior[a], (std::vector<double>{0.5, 0.25, 0.25}));
  const auto& confusion = knowledge.sensor("a").confusion[a];
  ASSERT_EQ(confusion.size(), 3u);
  const double tolerance = 1e-15;  // one rounding of numbers below 1
  EXPECT_NEAR(confusion[0][0], 0.8, tolerance);
  EXPECT_NEAR(confusion[0][2], 0.1, tolerance);                 // half of what is left
  EXPECT_EQ(confusion[1], (std::vector<double>{0.5, 0.5, 0}));  // normalised
  EXPECT_EQ(confusion[2], (std::vector<double>{0, 0, 1}));      // without a row: as itself
  EXPECT_EQ(knowledge.default_sensor.prior[a], std::vector<double>(3, 1.0 / 3));
  EXPECT_TRUE(knowledge.default_sensor.confusion[a].empty());
}

TEST(Configuration, APriorOfZeroIsKeptAboveZero) {
  const Knowledge knowledge =
      with(R"("sensors": {"a": {"prior": {"class": {"cup": 1, "box": 0}}}})");
  const auto& prior =
      knowledge.sensor("a").prior[static_cast<std::size_t>(knowledge.class_attribute)];
  EXPECT_NEAR(prior[1], 1e-6, 1e-11);  // 1e-6 before it was normalised by 1 + 2e-6
}

TEST(Configuration, AnyPriorBecomesADistribution) {
  EXPECT_TRUE(rc::check([] {
    const double cup = *rc::gen::inRange(0, 1000) / 1000.0;
    const double box = *rc::gen::inRange(0, 1000) / 1000.0 * (1 - cup);
    const Knowledge knowledge =
        with(R"("sensors": {"a": {"prior": {"class": {"cup": )" + std::to_string(cup) +
             R"(, "box": )" + std::to_string(box) + "}}}}");
    const auto& prior =
        knowledge.sensor("a").prior.at(static_cast<std::size_t>(knowledge.class_attribute));
    double sum = 0;
    for (const double p : prior) {
      RC_ASSERT(p > 0);
      sum += p;
    }
    RC_ASSERT(std::abs(sum - 1) < 1e-12);  // three roundings of numbers below 1
  }));
}

TEST(Configuration, AWorldOfTwoDimensionsTakesTwoNumbersAndFour) {
  const Knowledge knowledge = knowledge_of(parse_configuration(R"({
    "world": {"dimensions": 2, "bounds": {"min": [-1000, -1000], "max": [1000, 1000]}},
    "classes": {"default": {"arrivals": [
      {"mean": [400, -600], "covariance": [100, 1, 1, 50], "rate": 0.1}]}},
    "sensors": {"radar": {"noise": [100, 0, 0, 100],
                          "view": {"type": "frustum", "range": [0, 9], "hfov": 1}}}})"));
  EXPECT_EQ(knowledge.dims, 2);
  EXPECT_EQ(knowledge.bounds_min, Eigen::Vector3d(-1000, -1000, 0));
  EXPECT_EQ(knowledge.bounds_max, Eigen::Vector3d(1000, 1000, 0));
  EXPECT_EQ(knowledge.cell, 1);  // 0.25 m would make 64 million cells; 1 m makes 4 million
  const Arrival& arrival = knowledge.classes[0].arrivals[0];
  EXPECT_EQ(arrival.mean, Eigen::Vector3d(400, -600, 0));
  EXPECT_EQ(arrival.covariance(0, 1), 1);
  EXPECT_EQ(arrival.covariance(1, 1), 50);
  EXPECT_EQ(arrival.covariance(2, 2), 0);
  EXPECT_EQ(knowledge.sensor("radar").noise.size(), 4u);
}

TEST(Configuration, CommentsAreAllowed) {
  EXPECT_TRUE(parse_configuration("// flat\n{" + kWorld + "/* done */}").ok());
}

TEST(Configuration, EverythingWrongIsSaidAtOnceInTheOrderOfTheSections) {
  const Configuration configuration = parse_configuration(R"({
    "world": {"bounds": {"min": [0, 0, 0], "max": [5, 5, 3]}, "sell": 0.5},
    "attributes": {"class": {"kind": "categorical", "symbols": ["cup", "cup"]}},
    "classes": {"cup": {"detection_probability": 1.5,
                        "models": [{"kind": "constant_position"},
                                   {"kind": "somewhere", "place": "tabel"}]}},
    "sensors": {"default": {"clutter_density": 0}, "kinect": {"noise": "little"}},
    "hypotheses": {"max": "many"}})");
  std::vector<std::string> paths;
  for (const auto& mistake : configuration.mistakes()) paths.push_back(mistake.path);
  EXPECT_EQ(paths, (std::vector<std::string>{
                       "world.sell", "attributes.class.symbols[1]", "classes.cup.models[1].place",
                       "classes.cup.detection_probability", "sensors.default.clutter_density",
                       "sensors.kinect.noise", "hypotheses.max"}))
      << all_text(configuration);
}

TEST(Configuration, DeepNestingAndLongTextsAreRefused) {
  const auto deep = parse_configuration(std::string(100'000, '[')).mistakes();
  ASSERT_EQ(deep.size(), 1u);
  EXPECT_NE(deep[0].message.find("nested"), std::string::npos);
  const auto large =
      parse_configuration("{" + kWorld + std::string(5'000'000, ' ') + "}").mistakes();
  ASSERT_EQ(large.size(), 1u);
  EXPECT_NE(large[0].message.find("4 MB"), std::string::npos);
}

TEST(Configuration, HomeIsWithoutMistakes) {
  const Knowledge home =
      knowledge_of(read_configuration(fs::path(ANCHORD_SOURCE_DIR) / "config" / "home.json"));
  EXPECT_EQ(home.classes.size(), 25u);
  EXPECT_GE(home.find_place("kitchen_table"), 0);
  EXPECT_EQ(home.world().volume(3), 12 * 9 * 2.6);
  for (const Place& place : home.places) {
    for (const Eigen::Vector2d& corner : place.region.polygon) {
      EXPECT_TRUE((corner.array() >= home.bounds_min.head<2>().array()).all() &&
                  (corner.array() <= home.bounds_max.head<2>().array()).all())
          << place.name;
      // A room's walls belong to it only on one side, so corners are pulled in by a millimetre.
      Eigen::Vector2d center = Eigen::Vector2d::Zero();
      for (const auto& other : place.region.polygon) center += other;
      center /= static_cast<double>(place.region.polygon.size());
      const Eigen::Vector2d inside = corner + 1e-3 * (center - corner).normalized();
      if (place.parent < 0) continue;
      EXPECT_TRUE(home.places[static_cast<std::size_t>(place.parent)].region.contains(
          {inside.x(), inside.y(), (place.region.z_min + place.region.z_max) / 2}, 3))
          << place.name << " is not inside its parent";
    }
  }
  for (const ObjectClass& object_class : home.classes) {
    // What the file says of itself: the intensity is in balance, to the two digits it is given in.
    double arrivals = object_class.arrival_rate;
    EXPECT_GT(arrivals, 0) << object_class.name;
    if (object_class.arrivals.empty()) {
      EXPECT_NEAR(arrivals / object_class.departure_rate / object_class.undetected_intensity, 1,
                  0.05)
          << object_class.name;
    }
  }
}

}  // namespace
}  // namespace anchord
