// What a world refuses: it names the field, and nothing has changed.

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

CartesianMeasurement& position_of(Frame& f) {
  return std::get<CartesianMeasurement>(f.detections[1].measurement);
}
SymbolReport& color_of(Frame& f) {
  return std::get<SymbolReport>(f.detections[1].attributes[0].value);
}
ScalarReport& size_of(Frame& f) {
  return std::get<ScalarReport>(f.detections[1].attributes[1].value);
}
PolarMeasurement& polar(Frame& f) {
  f.detections[1].measurement = PolarMeasurement{2, 0.1, 0, {0.01, 0.01, 0.01}};
  return std::get<PolarMeasurement>(f.detections[1].measurement);
}

/// A frame with nothing wrong, a second after those before.
Frame good_frame() {
  Frame f = frame(1, {at(1, 1), at(2, 2, "color", "red", 0.7)});
  f.detections[1].attributes.push_back({"size", ScalarReport{0.1, 0.01}});
  f.detections[1].score = 0.5;
  f.detections[1].yaw = 0.5;
  f.pose = Pose{};
  f.view = View{};
  f.view->type = View::Type::kSector;
  f.view->range = {0, 5};
  f.view->bearing = {-1, 1};
  return f;
}

struct Fault {
  std::string name;
  std::function<void(Frame&)> make;
  std::string field;  ///< that the refusal must begin with
  ErrorCode code = ErrorCode::kInvalid;
};

std::vector<Fault> faults() {
  std::vector<Fault> all{
      {"1970", [](Frame& f) { f.utime = 1; }, "utime"},
      {"1969", [](Frame& f) { f.utime = -1; }, "utime"},
      {"3000", [](Frame& f) { f.utime = 32'503'680'000'000'000; }, "utime"},
      {"the least time", [](Frame& f) { f.utime = std::numeric_limits<Utime>::min(); }, "utime"},
      {"the largest time", [](Frame& f) { f.utime = std::numeric_limits<Utime>::max(); }, "utime"},
      {"time of its sensor's last frame", [](Frame& f) { f.utime = at_second(0.9); }, "utime",
       ErrorCode::kConflict},
      {"time before its sensor's last frame", [](Frame& f) { f.utime = at_second(0.7); }, "utime",
       ErrorCode::kConflict},
      {"too late",
       [](Frame& f) {
         f.utime = at_second(0.9 - 0.500001);
         f.sensor = "slow";
       },
       "utime", ErrorCode::kConflict},
      {"no sensor", [](Frame& f) { f.sensor.clear(); }, "sensor"},
      {"10,001 detections",
       [](Frame& f) { f.detections.assign(kMaxDetections + 1, f.detections[0]); }, "detections",
       ErrorCode::kTooLarge},
      {"quaternion of norm 0",
       [](Frame& f) {
         f.pose->orientation = {0, 0, 0, 0};
       },
       "pose.orientation"},
      {"quaternion of norm 1.02",
       [](Frame& f) {
         f.pose->orientation = {1.02, 0, 0, 0};
       },
       "pose.orientation"},
      {"pose covariance not symmetric", [](Frame& f) { f.pose->covariance[1] = 0.1; },
       "pose.covariance"},
      {"pose covariance negative", [](Frame& f) { f.pose->covariance[35] = -0.1; },
       "pose.covariance"},
      {"covariance not symmetric",
       [](Frame& f) {
         position_of(f).covariance = {1, 0.5, 0.4, 1};
       },
       "detections[1].covariance"},
      {"covariance indefinite",
       [](Frame& f) {
         position_of(f).covariance = {1, 2, 2, 1};
       },
       "detections[1].covariance"},
      {"covariance singular",
       [](Frame& f) {
         position_of(f).covariance = {1, 1, 1, 1};
       },
       "detections[1].covariance"},
      {"covariance zero",
       [](Frame& f) {
         position_of(f).covariance = {0, 0, 0, 0};
       },
       "detections[1].covariance"},
      {"covariance of 3 numbers", [](Frame& f) { position_of(f).covariance.pop_back(); },
       "detections[1].covariance"},
      {"no covariance and no noise", [](Frame& f) { position_of(f).covariance.clear(); },
       "detections[1].covariance"},
      {"position of 1 number", [](Frame& f) { position_of(f).position.pop_back(); },
       "detections[1].position"},
      {"range 0", [](Frame& f) { polar(f).range = 0; }, "detections[1].polar.range"},
      {"range negative", [](Frame& f) { polar(f).range = -1; }, "detections[1].polar.range"},
      {"polar variance 0", [](Frame& f) { polar(f).variance[1] = 0; },
       "detections[1].polar.variance"},
      {"polar variance missing", [](Frame& f) { polar(f).variance.clear(); },
       "detections[1].polar.variance"},
      {"score 1.1", [](Frame& f) { f.detections[1].score = 1.1; }, "detections[1].score"},
      {"score -0.1", [](Frame& f) { f.detections[1].score = -0.1; }, "detections[1].score"},
      {"probability 1.1", [](Frame& f) { color_of(f).probabilities[0].second = 1.1; },
       "detections[1].attributes.color.red"},
      {"probability -0.1", [](Frame& f) { color_of(f).probabilities[0].second = -0.1; },
       "detections[1].attributes.color.red"},
      {"probabilities all zero",
       [](Frame& f) {
         color_of(f).probabilities = {{"red", 0}};
       },
       "detections[1].attributes.color"},
      {"no probabilities", [](Frame& f) { color_of(f).probabilities.clear(); },
       "detections[1].attributes.color"},
      {"probabilities over 1.001",
       [](Frame& f) {
         color_of(f).probabilities = {{"red", 0.6}, {"blue", 0.402}};
       },
       "detections[1].attributes.color"},
      {"symbol twice",
       [](Frame& f) {
         color_of(f).probabilities = {{"red", 0.2}, {"red", 0.2}};
       },
       "detections[1].attributes.color.red"},
      {"unknown symbol",
       [](Frame& f) {
         color_of(f).probabilities = {{"rot", 0.2}};
       },
       "detections[1].attributes.color.rot"},
      {"unknown attribute", [](Frame& f) { f.detections[1].attributes[0].name = "colour"; },
       "detections[1].attributes.colour"},
      {"attribute twice",
       [](Frame& f) { f.detections[1].attributes.push_back(f.detections[1].attributes[0]); },
       "detections[1].attributes.color"},
      {"a scalar of a categorical attribute",
       [](Frame& f) {
         f.detections[1].attributes[0].value = ScalarReport{1, 1};
       },
       "detections[1].attributes.color"},
      {"symbols of a scalar attribute",
       [](Frame& f) {
         f.detections[1].attributes[1].value = SymbolReport{{{"small", 1}}};
       },
       "detections[1].attributes.size"},
      {"scalar variance 0", [](Frame& f) { size_of(f).variance = 0; },
       "detections[1].attributes.size.variance"},
      {"range reversed",
       [](Frame& f) {
         f.view->range = {5, 1};
       },
       "view.range"},
      {"polygon of two points",
       [](Frame& f) {
         f.view->type = View::Type::kPolygon;
         f.view->points = {{0, 0}, {1, 1}};
       },
       "view.points"},
      {"hfov of pi",
       [](Frame& f) {
         f.view->type = View::Type::kFrustum;
         f.view->hfov = 3.15;
         f.view->vfov = 1;
       },
       "view.hfov"},
  };
  for (const double bad : {kNaN, kInf, -kInf}) {
    const std::string text = std::to_string(bad) + " in ";
    const auto add = [&](const std::string& name, std::function<void(Frame&)> make,
                         const std::string& field) {
      all.push_back({text + name, std::move(make), field});
    };
    const std::string z = "detections[1].";
    add(
        "position", [=](Frame& f) { position_of(f).position[1] = bad; }, z + "position");
    add(
        "covariance", [=](Frame& f) { position_of(f).covariance[3] = bad; }, z + "covariance");
    add(
        "cross-covariance",
        [=](Frame& f) { position_of(f).covariance[1] = position_of(f).covariance[2] = bad; },
        z + "covariance");
    add(
        "polar range", [=](Frame& f) { polar(f).range = bad; }, z + "polar.range");
    add(
        "polar bearing", [=](Frame& f) { polar(f).bearing = bad; }, z + "polar.bearing");
    add(
        "polar variance", [=](Frame& f) { polar(f).variance[0] = bad; }, z + "polar.variance");
    add(
        "score", [=](Frame& f) { f.detections[1].score = bad; }, z + "score");
    add(
        "yaw", [=](Frame& f) { f.detections[1].yaw = bad; }, z + "yaw");
    add(
        "probability", [=](Frame& f) { color_of(f).probabilities[0].second = bad; },
        z + "attributes.color.red");
    add(
        "mean", [=](Frame& f) { size_of(f).mean = bad; }, z + "attributes.size.mean");
    add(
        "variance", [=](Frame& f) { size_of(f).variance = bad; }, z + "attributes.size.variance");
    add(
        "pose position", [=](Frame& f) { f.pose->position[2] = bad; }, "pose.position");
    add(
        "orientation", [=](Frame& f) { f.pose->orientation[3] = bad; }, "pose.orientation");
    add(
        "pose covariance", [=](Frame& f) { f.pose->covariance[14] = bad; }, "pose.covariance");
    add(
        "range", [=](Frame& f) { f.view->range[1] = bad; }, "view.range");
    add(
        "bearing", [=](Frame& f) { f.view->bearing[0] = bad; }, "view.bearing");
    add(
        "polygon",
        [=](Frame& f) {
          f.view->type = View::Type::kPolygon;
          f.view->points = {{0, 0}, {1, bad}, {1, 0}};
        },
        "view.points");
  }
  return all;
}

TEST(Refusal, NamesTheFieldAndChangesNothing) {
  World world(small_world());
  apply(world, {frame(0, {at(1, 1), at(2, 2)}), frame(0.9, {at(1, 1.01), at(2.1, 2)})});
  const std::string before = everything(world);
  const auto belief = world.belief();
  for (const Fault& fault : faults()) {
    SCOPED_TRACE(fault.name);
    Frame bad = good_frame();
    fault.make(bad);
    const Status refused = world.apply(bad);
    ASSERT_FALSE(refused.ok());
    EXPECT_TRUE(refused.error().field.starts_with(fault.field)) << refused.error().text();
    EXPECT_EQ(refused.error().code, fault.code);
    EXPECT_FALSE(refused.error().message.empty());
    EXPECT_EQ(world.belief(), belief);
    EXPECT_EQ(everything(world), before);
  }
}

TEST(Refusal, LeavesNoTraceInWhatFollows) {
  World world(small_world()), other(small_world());
  for (World* w : {&world, &other}) apply(*w, {frame(0, {at(1, 1), at(2, 2)}), frame(0.9, {})});
  for (const Fault& fault : faults()) {
    Frame bad = good_frame();
    fault.make(bad);
    EXPECT_FALSE(world.apply(bad).ok()) << fault.name;
  }
  for (World* w : {&world, &other}) apply(*w, {good_frame(), frame(1.2, {at(1, 1)}, "late")});
  EXPECT_EQ(everything(world), everything(other));
}

TEST(Refusal, TheEdgesOfWhatIsTaken) {
  const auto takes = [](const std::function<void(Frame&)>& make) {
    World world(small_world());
    apply(world, {frame(0.9, {at(1, 1)}, "other")});
    Frame f = good_frame();
    make(f);
    return world.apply(f).ok();
  };
  EXPECT_TRUE(takes([](Frame&) {}));
  EXPECT_TRUE(takes([](Frame& f) { f.utime = at_second(0.4); })) << "max_lateness, to the us";
  EXPECT_TRUE(takes([](Frame& f) { color_of(f).probabilities = {{"red", 0.6}, {"blue", 0.401}}; }));
  EXPECT_TRUE(takes([](Frame& f) { f.pose->orientation = {1.0099, 0, 0, 0}; }));
  EXPECT_TRUE(takes([](Frame& f) { f.detections[1].score = 1; }));
  EXPECT_TRUE(takes([](Frame& f) { f.detections.clear(); }));
}

TEST(Refusal, SensorsOfTwoRobotsAreTwoSensors) {
  World world(small_world());
  Frame f = frame(1, {at(1, 1)});
  f.robot = "amigo";
  apply(world, {f});
  f.robot = "sergio";
  apply(world, {f});
  EXPECT_EQ(world.apply(f).error().code, ErrorCode::kConflict);
}

}  // namespace
}  // namespace anchord
