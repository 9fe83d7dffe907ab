#include "tests/anchoring/enumeration.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/anchoring/enumerated_object.h"

/// The enumeration against cases that are worked out by hand. The numbers are few and the formulas
/// short, so that only rounding separates them: 1e-12.
namespace anchord::enumeration {
namespace {

constexpr double kRounding = 1e-12;
constexpr double kKappa = 0.05, kLambda = 0.2, kDetected = 0.8;  // any, but no round ratios
constexpr double kVariance = 0.04;                               // of detections, m^2
constexpr Utime kStart = 1'700'000'000'000'000;

BehaviourModel still() {
  BehaviourModel model;
  model.initial_weight = 1;
  return model;
}

View view(View::Type type, std::vector<std::array<double, 2>> points = {}) {
  View v;
  v.type = type;
  v.points = std::move(points);
  return v;
}

Attribute categorical(const char* name, std::vector<std::string> symbols) {
  Attribute attribute;
  attribute.name = name;
  attribute.symbols = std::move(symbols);
  return attribute;
}

/// A 4 m x 4 m world of 1 m cells with one class of resting objects and one sensor.
Knowledge plain() {
  Knowledge k;
  k.dims = 2;
  k.cell = 1;
  k.bounds_max = {4, 4, 0};
  ObjectClass object;
  object.name = "object";
  object.models = {still()};
  object.undetected_intensity = kLambda;
  k.classes = {object};
  k.default_sensor.clutter_density = kKappa;
  k.default_sensor.detection_probability = {kDetected};
  k.default_sensor.view = view(View::Type::kWorld);
  return k;
}

/// The same with the classes cup and box, equal but for their intensities.
Knowledge two_classes(double cups, double boxes) {
  Knowledge k = plain();
  k.attributes = {categorical("class", {"cup", "box"})};
  k.class_attribute = 0;
  k.classes.push_back(k.classes[0]);
  k.classes[0].undetected_intensity = cups;
  k.classes[1].undetected_intensity = boxes;
  k.default_sensor.detection_probability = {kDetected, kDetected};
  return k;
}

Detection at(double x, double y) {
  Detection detection;
  detection.measurement = CartesianMeasurement{{x, y}, {kVariance, 0, 0, kVariance}};
  return detection;
}

Frame frame(double seconds, std::vector<Detection> detections) {
  Frame f;
  f.utime = kStart + from_seconds(seconds);
  f.detections = std::move(detections);
  return f;
}

Frame blind(Frame f) {
  f.view = view(View::Type::kNone);
  return f;
}

/// Normal density of the plane with one variance, at a distance.
double density(double distance, double variance) {
  return std::exp(-distance * distance / 2 / variance) / (2 * std::numbers::pi * variance);
}

const double kNew = kDetected * kLambda;       // e(z)
const double kFirst = kNew / (kKappa + kNew);  // r after one detection

TEST(Enumeration, OneDetectionIsNewOrClutter) {
  const EnumeratedBelief belief = enumerate(plain(), {frame(0, {at(1.5, 2.5)})});
  EXPECT_EQ(belief.worlds, 2u);
  EXPECT_NEAR(belief.evidence, kKappa + kNew, kRounding);
  const EnumeratedObject& object = belief.objects.at({0, 0});
  EXPECT_NEAR(object.p_exists, kFirst, kRounding);
  EXPECT_NEAR(belief.origins[0][0].p_new, kFirst, kRounding);
  EXPECT_NEAR(belief.origins[0][0].p_clutter, 1 - kFirst, kRounding);
  EXPECT_NEAR(object.mean(1), 2.5, kRounding);
  EXPECT_NEAR(object.covariance(0, 0), kVariance, kRounding);
  EXPECT_NEAR(belief.undetected[0], 16 * kLambda * (1 - kDetected), kRounding);
}

TEST(Enumeration, AMissMakesAnObjectLessProbable) {
  const EnumeratedBelief belief = enumerate(plain(), {frame(0, {at(1, 1)}), frame(1, {})});
  EXPECT_NEAR(belief.objects.at({0, 0}).p_exists,
              kFirst * (1 - kDetected) / (1 - kFirst * kDetected), kRounding);
}

TEST(Enumeration, AMissOutOfViewSaysNothing) {
  const EnumeratedBelief belief = enumerate(plain(), {frame(0, {at(1, 1)}), blind(frame(1, {}))});
  EXPECT_NEAR(belief.objects.at({0, 0}).p_exists, kFirst, kRounding);
}

TEST(Enumeration, AViewCountsByTheMassInsideIt) {
  Frame half = frame(1, {});
  half.view = view(View::Type::kPolygon, {{-3, -3}, {1, -3}, {1, 5}, {-3, 5}});
  const EnumeratedBelief belief = enumerate(plain(), {frame(0, {at(1.1, 1)}), half});
  // 1.1 lies half a standard deviation (0.2) right of the border at 1; all else is 20 of them off.
  const double q = kDetected * std::erfc(0.5 / std::sqrt(2.0)) / 2;
  EXPECT_NEAR(belief.objects.at({0, 0}).p_exists, kFirst * (1 - q) / (1 - kFirst * q), kRounding);
  // The column of 4 cells was seen twice, the other 12 once.
  const double missed = 1 - kDetected;
  EXPECT_NEAR(belief.undetected[0], kLambda * (4 * missed * missed + 12 * missed), kRounding);
}

TEST(Enumeration, DepartureIsAWorldOfItsOwn) {
  Knowledge k = plain();
  k.classes[0].departure_rate = 0.3;
  const EnumeratedBelief belief = enumerate(k, {frame(0, {at(1, 1)}), blind(frame(2, {}))});
  EXPECT_EQ(belief.worlds, 3u);
  EXPECT_NEAR(belief.objects.at({0, 0}).p_exists, kFirst * std::exp(-0.6), kRounding);
  EXPECT_NEAR(belief.origins[0][0].p_new, kFirst, kRounding);
}

TEST(Enumeration, TwoObjectsCompeteForOneDetection) {
  // Two objects 0.6 m apart, then one detection 0.2 m from the first.
  const EnumeratedBelief belief =
      enumerate(plain(), {frame(0, {at(1, 1), at(1.6, 1)}), frame(1, {at(1.2, 1)})});
  const double ratio = kNew / kKappa;  // exists : clutter
  const double g0 = kDetected * density(0.2, 2 * kVariance);
  const double g1 = kDetected * density(0.4, 2 * kVariance);
  const double miss = 1 - kDetected;
  const double fresh = kKappa + kNew * miss;  // lambda has fallen by the first look
  // Over which of the two exist; in units of kappa^2.
  const double none = fresh;
  const double first = ratio * (g0 + miss * fresh), second = ratio * (g1 + miss * fresh);
  const double both = ratio * ratio * (g0 * miss + g1 * miss + miss * miss * fresh);
  const double total = none + first + second + both;
  EXPECT_NEAR(belief.evidence, total * kKappa * kKappa, kRounding);
  EXPECT_NEAR(belief.objects.at({0, 0}).p_exists, (first + both) / total, kRounding);
  EXPECT_NEAR(belief.objects.at({0, 1}).p_exists, (second + both) / total, kRounding);
  EXPECT_NEAR(belief.origins[1][0].objects.at({0, 0}), ratio * g0 * (1 + ratio * miss) / total,
              kRounding);
}

TEST(Enumeration, AScoreScalesClutter) {
  Detection detection = at(1, 1);
  detection.score = 0.9;
  EXPECT_NEAR(enumerate(plain(), {frame(0, {detection})}).objects.at({0, 0}).p_exists,
              kNew / (kKappa / 9 + kNew), kRounding);
  detection.score = 0;
  EXPECT_NEAR(enumerate(plain(), {frame(0, {detection})}).objects.at({0, 0}).p_exists,
              kNew / (kKappa * (1 - 1e-6) / 1e-6 + kNew), kRounding);
}

TEST(Enumeration, IdentityIsDoubted) {
  Knowledge k = plain();
  k.default_sensor.identity_doubt = 0.1;
  Detection named = at(1.2, 1);
  named.object = reference({0, 0});
  const EnumeratedBelief belief = enumerate(k, {frame(0, {at(1, 1)}), frame(1, {named})});
  const double g = kDetected * density(0.2, 2 * kVariance), miss = 1 - kDetected;
  const double other = 0.1 * (kKappa + kNew * miss);
  const double from = kFirst * g, total = from + kFirst * miss * other + (1 - kFirst) * other;
  EXPECT_NEAR(belief.origins[1][0].objects.at({0, 0}), from / total, kRounding);
}

TEST(Enumeration, ArrivalsAndDeparturesMoveTheUndetected) {
  Knowledge k = plain();
  k.places = {{.name = "door", .kind = "room", .region = {{{0, 0}, {2, 0}, {2, 1}, {0, 1}}}}};
  k.classes[0].departure_rate = 0.5;
  k.classes[0].arrival_rate = 0.03;
  k.classes[0].arrivals = {{.place = 0, .rate = 0.4}};
  const EnumeratedBelief belief =
      enumerate(k, {blind(frame(0, {})), blind(frame(3, {at(0.5, 0.5), at(9, 9)}))});
  const double stay = std::exp(-1.5), time = (1 - stay) / 0.5;
  EXPECT_NEAR(belief.undetected[0], 16 * (kLambda * stay + 0.03 * time) + 0.4 * time, kRounding);
  const double e = kDetected * (kLambda * stay + (0.03 + 0.4 / 2) * time);
  EXPECT_NEAR(belief.origins[1][0].p_new, e / (kKappa + e), kRounding);
  EXPECT_NEAR(belief.origins[1][1].p_new, kFirst, kRounding);  // outside the bounds
}

TEST(Enumeration, AClassIsReportedThroughPriorOrConfusion) {
  Knowledge k = two_classes(0.1, 0.3);
  Detection detection = at(1, 1);
  detection.attributes = {{"class", SymbolReport{{{"cup", 0.7}}}}};
  k.default_sensor.prior = {{0.4, 0.6}};
  const double cup = 0.1 * 0.7 / 0.4, box = 0.3 * 0.3 / 0.6;
  EXPECT_NEAR(enumerate(k, {frame(0, {detection})}).objects.at({0, 0}).classes[0],
              cup / (cup + box), kRounding);
  k.default_sensor.confusion = {{{0.9, 0.1}, {0.2, 0.8}}};
  const double as_cup = 0.1 * (0.7 * 0.9 + 0.3 * 0.1), as_box = 0.3 * (0.7 * 0.2 + 0.3 * 0.8);
  const double mean = (as_cup / 0.1 + as_box / 0.3) / 2;
  const EnumeratedBelief belief = enumerate(k, {frame(0, {detection})});
  EXPECT_NEAR(belief.objects.at({0, 0}).classes[0], as_cup / (as_cup + as_box), kRounding);
  EXPECT_NEAR(belief.evidence, kKappa + kDetected * (as_cup + as_box) / mean, kRounding);
}

TEST(Enumeration, AReportOfOneIsFloored) {
  const Attribute color = categorical("color", {"red", "green", "blue"});
  const Eigen::VectorXd ratio = symbol_ratio({{{"green", 1}}}, color, Sensor{}, 0);
  EXPECT_NEAR(ratio(0), 3e-6 / (1 + 2e-6), kRounding);
  EXPECT_NEAR(ratio(1), 3 / (1 + 2e-6), kRounding);
}

TEST(Enumeration, SurvivalDependsOnTheClass) {
  Knowledge k = two_classes(0.1, 0.3);
  k.classes[0].departure_rate = 0.2;
  k.classes[1].departure_rate = 1;
  const EnumeratedBelief belief = enumerate(k, {frame(0, {at(1, 1)}), blind(frame(1, {}))});
  const double cup = 0.25 * std::exp(-0.2), box = 0.75 * std::exp(-1.0);
  EXPECT_NEAR(belief.objects.at({0, 0}).p_exists, (cup + box) * 0.32 / (0.32 + kKappa), kRounding)
      << "0.32 = p_D (0.1 + 0.3)";
  EXPECT_NEAR(belief.objects.at({0, 0}).classes[0], cup / (cup + box), kRounding);
}

TEST(Enumeration, AttributesAreRatiosToClutter) {
  Knowledge k = plain();
  Attribute size;
  size.name = "size";
  size.kind = Attribute::Kind::kScalar;
  size.reference_density = 2;
  k.attributes = {categorical("color", {"red", "blue"}), size};
  Detection first = at(1, 1), second = at(1, 1);
  first.attributes = {{"color", SymbolReport{{{"red", 0.8}}}}, {"size", ScalarReport{0.1, 0.01}}};
  second.attributes = {{"color", SymbolReport{{{"red", 0.6}}}}, {"size", ScalarReport{0.2, 0.03}}};
  const EnumeratedBelief belief = enumerate(k, {frame(0, {first}), frame(1, {second})});
  const double color = 2 * (0.8 * 0.6 + 0.2 * 0.4);
  const double likeness = std::exp(-0.01 / 2 / 0.04) / std::sqrt(2 * std::numbers::pi * 0.04) / 2;
  const double from = kFirst * kDetected * density(0, 2 * kVariance) * color * likeness;
  const double other = (1 - kFirst * kDetected) * (kKappa + kNew * (1 - kDetected));
  EXPECT_NEAR(belief.origins[1][0].objects.at({0, 0}), from / (from + other), kRounding);
  // Where it was detected again: red 0.48 : 0.08, size 0.125 +- 0.0075; else as first reported.
  const EnumeratedObject& object = belief.objects.at({0, 0});
  const double again = from / (from + other) / object.p_exists;
  EXPECT_NEAR(object.symbols.at(0).belief[0], again * 6 / 7 + (1 - again) * 0.8, kRounding);
  EXPECT_NEAR(object.scalars.at(1).mean, again * 0.125 + (1 - again) * 0.1, kRounding);
}

TEST(Enumeration, AnObjectIsFoundSomewhere) {
  Knowledge k = plain();
  k.places = {{.name = "table", .kind = "surface", .region = {{{2, 2}, {4, 2}, {4, 4}, {2, 4}}}}};
  BehaviourModel somewhere;
  somewhere.kind = BehaviourModel::Kind::kSomewhere;
  somewhere.place = 0;
  somewhere.rate = 0.5;
  k.classes[0].models.push_back(somewhere);
  // In a second it goes there with probability w; half the table is searched in vain; then it is
  // detected in the other half, where the first model (at 0.5, 0.5) gives 1e-34.
  Frame search = frame(1, {});
  search.view = view(View::Type::kPolygon, {{2, 2}, {3, 2}, {3, 4}, {2, 4}});
  const EnumeratedBelief belief =
      enumerate(k, {frame(0, {at(0.5, 0.5)}), search, blind(frame(1, {at(3.5, 3.5)}))});
  const double w = 1 - std::exp(-0.5), q = kDetected * w / 2;
  const double searched = kFirst * (1 - q) / (1 - kFirst * q);
  const double density_there = (w / 4) / (1 - q);  // of all mass, per m^2
  const double from = searched * kDetected * density_there;
  const double other = kKappa + kNew * (1 - kDetected);  // that half was looked at once
  EXPECT_NEAR(belief.origins[2][0].objects.at({0, 0}), from / (from + other), kRounding);
}

TEST(Enumeration, SomewhereThatIsFoundMergesByMoments) {
  Knowledge k = plain();
  BehaviourModel& tracked = k.classes[0].models[0];
  tracked.kind = BehaviourModel::Kind::kConstantVelocity;
  tracked.initial_velocity_variance = 0.5;
  BehaviourModel somewhere;
  somewhere.kind = BehaviourModel::Kind::kSomewhere;
  tracked.initial_weight = 0.7;
  somewhere.initial_weight = 0.3;
  k.classes[0].models.push_back(somewhere);
  const Laws laws(k);
  const Sensor& sensor = k.default_sensor;
  Object object = laws.born(measure(k, sensor, at(1.5, 1.5)), {}, Eigen::VectorXd::Ones(1));
  const double g = laws.detect(object, sensor, {}, measure(k, sensor, at(1.9, 1.5)));
  const double a = 0.7 * density(0.4, 2 * kVariance), b = 0.3 / 16;
  EXPECT_NEAR(g, kDetected * (a + b), kRounding);
  const double w = a / (a + b);  // tracked: mean 1.7, variance 0.02; found: 1.9 and 0.04
  EXPECT_NEAR(object.models[0].weight, 1, kRounding);
  EXPECT_EQ(object.models[1].weight, 0);
  EXPECT_NEAR(object.models[0].state.mean(0), w * 1.7 + (1 - w) * 1.9, kRounding);
  EXPECT_NEAR(object.models[0].state.covariance(0, 0),
              w * 0.02 + (1 - w) * 0.04 + w * (1 - w) * 0.04, kRounding);
  EXPECT_NEAR(object.models[0].state.covariance(2, 2), 0.5, kRounding);
}

TEST(Enumeration, AnUndetectableModelOutlivesMisses) {
  Knowledge k = plain();
  BehaviourModel hidden = still();
  hidden.detectable = false;
  hidden.initial_weight = 0;
  k.classes[0].models.push_back(hidden);
  k.classes[0].transitions = {{0, 1, 0.6}, {1, 0, 0.2}};
  const EnumeratedBelief belief = enumerate(k, {frame(0, {at(1, 1)}), frame(1, {})});
  const double w = 0.6 / 0.8 * (1 - std::exp(-0.8));  // of a two-state chain
  const double q = kDetected * (1 - w);
  const EnumeratedObject& object = belief.objects.at({0, 0});
  EXPECT_NEAR(object.p_exists, kFirst * (1 - q) / (1 - kFirst * q), kRounding);
  EXPECT_NEAR(object.models[0][1], w / (1 - q), kRounding);
}

TEST(Enumeration, ATrackedModelTakesTheMomentsOfAnother) {
  Knowledge k = plain();
  k.classes[0].models[0].psd = 0.3;
  BehaviourModel moving;
  moving.kind = BehaviourModel::Kind::kConstantVelocity;
  moving.psd = 0.9;
  moving.initial_velocity_variance = 0.5;
  moving.initial_weight = 0;
  k.classes[0].models.push_back(moving);
  k.classes[0].transitions = {{0, 1, 0.4}};
  const Laws laws(k);
  Object object = laws.born(measure(k, k.default_sensor, at(1, 1)), {}, Eigen::VectorXd::Ones(1));
  laws.predict(object, 1);  // all that has entered comes from the first: 0.04 + 0.3
  EXPECT_NEAR(object.models[1].weight, 1 - std::exp(-0.4), kRounding);
  EXPECT_NEAR(object.models[1].state.covariance(1, 1), 0.34, kRounding);
  EXPECT_NEAR(object.models[1].state.covariance(3, 3), 0.5, kRounding);
  laws.predict(object, 2);  // now with its own: 0.34 + 2^2 0.5 + 0.9 2^3 / 3, and 0.34 + 2 0.3
  const double stayed = 1 - std::exp(-0.4), all = 1 - std::exp(-1.2);
  EXPECT_NEAR(object.models[1].weight, all, kRounding);
  EXPECT_NEAR(object.models[1].state.covariance(1, 1),
              (stayed * (0.34 + 2 + 2.4) + (all - stayed) * 0.94) / all, kRounding);
}

TEST(Enumeration, DensitiesFollowTheMostProbableClass) {
  Knowledge k = two_classes(0.3, 0.1);  // cups at first
  k.places = {{.name = "table", .kind = "surface", .region = {{{0, 0}, {4, 0}, {4, 1}, {0, 1}}}}};
  BehaviourModel somewhere;
  somewhere.kind = BehaviourModel::Kind::kSomewhere;
  somewhere.rate = 0.5;
  k.classes[0].models.push_back(somewhere);
  k.classes[1].models[0].kind = BehaviourModel::Kind::kConstantVelocity;
  k.classes[1].models[0].initial_velocity_variance = 0.5;
  k.classes[0].departure_rate = 2;
  const Laws laws(k);
  const auto born = [&] {
    return Laws(k).born(measure(k, k.default_sensor, at(1, 1)), {}, Eigen::Vector2d(0.75, 0.25));
  };
  const double w = 1 - std::exp(-0.5);
  Object object = born();
  laws.predict(object, 1);  // b(cup) = 0.75 e^-2 < 0.25: now a box, which has no somewhere
  EXPECT_EQ(object.object_class, 1);
  ASSERT_EQ(object.models.size(), 1u);
  EXPECT_NEAR(object.models[0].weight, 1, kRounding);
  EXPECT_NEAR(object.models[0].state.mean(0), (1 - w) * 1 + w * 2, kRounding);
  EXPECT_NEAR(object.models[0].state.covariance(0, 0),  // uniform over 4 m: 16 / 12
              (1 - w) * kVariance + w * 16 / 12 + w * (1 - w), kRounding);
  EXPECT_NEAR(object.models[0].state.covariance(3, 3), 0.5, kRounding);

  somewhere.place = 0;  // a box that may be on the table only
  k.classes[1].models.push_back(somewhere);
  Object on_table = born();
  Laws(k).predict(on_table, 1);
  EXPECT_NEAR(on_table.models[1].weight, w, kRounding);
  EXPECT_NEAR(on_table.models[1].cells(3), 0.25, kRounding);
  EXPECT_EQ(on_table.models[1].cells(4), 0);
}

TEST(Enumeration, MissesTellClassesApart) {
  Knowledge k = two_classes(0.2, 0.2);
  k.default_sensor.detection_probability = {0.9, 0.3};
  const Laws laws(k);
  Object object = laws.born(measure(k, k.default_sensor, at(1, 1)), {}, Eigen::Vector2d(0.6, 0.4));
  const double q = 0.6 * 0.9 + 0.4 * 0.3;
  EXPECT_NEAR(laws.miss(object, k.default_sensor, Sight{true, {}}, {}), 1 - q, kRounding);
  EXPECT_NEAR(object.classes(0), 0.6 * 0.1 / (1 - q), kRounding);
  EXPECT_EQ(object.object_class, 1);
}

}  // namespace
}  // namespace anchord::enumeration
