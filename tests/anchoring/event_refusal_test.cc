// What a world refuses of events: it names the field, and nothing has changed.

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/anchoring/small_events.h"

namespace anchord {
namespace {

using Kind = Event::Kind;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Fault {
  std::string name;
  Event event;
  std::string field;
  ErrorCode code = ErrorCode::kInvalid;
};

Event changed(Event e, const std::function<void(Event&)>& change) {
  change(e);
  return e;
}

RegionOfInterest ellipsoid() {
  RegionOfInterest region;
  region.center = {1, 1, 0};
  region.covariance = {0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1};
  region.radius = 2;
  return region;
}

Event looked_at(const std::function<void(RegionOfInterest&)>& change) {
  RegionOfInterest region = ellipsoid();
  change(region);
  Event e = missing(1, "cup-1", ellipsoid());
  e.regions.push_back(region);
  return e;
}

Event looked_at_box(const std::function<void(RegionOfInterest&)>& change) {
  return looked_at([&](RegionOfInterest& region) {
    region = box_of_interest(1, 1, 2, 2);
    change(region);
  });
}

const Event kMoved = at_position(event(Kind::kMoved, 1, "cup-1"), 2, 2);

std::vector<Fault> faults() {
  const auto when = [](Utime utime) { return changed(kMoved, [=](Event& e) { e.utime = utime; }); };
  const auto covariance = [](std::array<double, 9> c) {
    return changed(kMoved, [=](Event& e) { e.covariance = c; });
  };
  std::vector<Fault> all{
      {"1970", when(1), "utime"},
      {"the least time", when(std::numeric_limits<Utime>::min()), "utime"},
      {"the largest time", when(std::numeric_limits<Utime>::max()), "utime"},
      {"too late", when(at_second(0.9 - 0.500001)), "utime", ErrorCode::kConflict},
      {"nobody", event(Kind::kMoved, 1), "object"},
      {"an unknown object", event(Kind::kGrasped, 1, "cup-9"), "object", ErrorCode::kUnknown},
      {"an object before it had its name", event(Kind::kGrasped, 0.85, "cup-3"), "object",
       ErrorCode::kUnknown},
      {"an unknown place", in_place(event(Kind::kPlaced, 1, "cup-1"), "attic"), "place"},
      {"a covariance of nothing",
       changed(event(Kind::kMoved, 1, "cup-1"), [](Event& e) { e.covariance.emplace(); }),
       "covariance"},
      {"covariance indefinite", covariance({1, 2, 0, 2, 1, 0, 0, 0, 1}), "covariance"},
      {"covariance not symmetric", covariance({1, 0.5, 0, 0.4, 1, 0, 0, 0, 1}), "covariance"},
      {"covariance zero", covariance({}), "covariance"},
      {"carried to nowhere", event(Kind::kCarried, 1), "position"},
      {"missed by nobody",
       changed(missing(1, "cup-1", ellipsoid()), [](Event& e) { e.sensor.clear(); }), "sensor"},
      {"looked for nowhere",
       changed(missing(1, "cup-1", ellipsoid()), [](Event& e) { e.regions.clear(); }), "regions"},
      {"257 regions",
       changed(missing(1, "cup-1", ellipsoid()),
               [](Event& e) { e.regions.assign(kMaxRegions + 1, ellipsoid()); }),
       "regions"},
      {"radius 0", looked_at([](auto& r) { r.radius = 0; }), "regions[1].radius"},
      {"radius NaN", looked_at([](auto& r) { r.radius = kNaN; }), "regions[1].radius"},
      {"p 1.1", looked_at([](auto& r) { r.p = 1.1; }), "regions[1].p"},
      {"p NaN", looked_at([](auto& r) { r.p = kNaN; }), "regions[1].p"},
      {"center NaN", looked_at([](auto& r) { r.center[1] = kNaN; }), "regions[1].center"},
      {"ellipsoid indefinite", looked_at([](auto& r) { r.covariance[0] = -1; }),
       "regions[1].covariance"},
      {"two points", looked_at_box([](auto& r) { r.polygon.resize(2); }), "regions[1].polygon"},
      {"crossing edges", looked_at_box([](auto& r) { std::swap(r.polygon[1], r.polygon[2]); }),
       "regions[1].polygon"},
      {"point infinite", looked_at_box([](auto& r) { r.polygon[1][0] = kInf; }),
       "regions[1].polygon"},
      {"a taken alias", named(1, "cup-1", "mug"), "name", ErrorCode::kConflict},
      {"a name as alias", named(1, "cup-1", "cup-2"), "name"},
      {"a control character", named(1, "cup-1", "a\nb"), "name"},
      {"129 bytes", named(1, "cup-1", std::string(129, 'a')), "name"},
      {"joined with nobody", joined(1, "cup-1", ""), "other"},
      {"joined with whom", joined(1, "cup-1", "cup-9"), "other", ErrorCode::kUnknown},
      {"joined with itself", joined(1, "cup-2", "mug"), "other", ErrorCode::kConflict},
      {"undo of a frame", undone(1, 1), "number", ErrorCode::kUnknown},
      {"undo of nothing", undone(1, 0), "number", ErrorCode::kUnknown},
      {"undo of what is to come", undone(1, 99), "number", ErrorCode::kUnknown},
      {"undo before it was said", undone(0.8, 3), "number", ErrorCode::kUnknown},
  };
  for (const double bad : {kNaN, kInf, -kInf}) {
    const std::string text = std::to_string(bad);
    all.push_back({text + " in position",
                   changed(kMoved, [=](Event& e) { (*e.position)[1] = bad; }), "position"});
    all.push_back(
        {text + " in covariance", covariance({1, 0, 0, 0, bad, 0, 0, 0, 1}), "covariance"});
  }
  return all;
}

/// Two cups, the second called mug by event 3 at 0.9 s; a third since then.
void prepare(World& world) {
  apply(world, {frame(0.5, {at(1, 1), at(4, 2)}), frame(0.9, {at(1, 1), at(4, 2), at(5, 3.5)})});
  ASSERT_EQ(apply(world, named(0.9, "cup-2", "mug")), 3);
  ASSERT_TRUE(find_anchor(*world.belief(), "cup-3"));
}

TEST(EventRefusal, NamesTheFieldAndChangesNothing) {
  World world(small_world());
  prepare(world);
  const std::string before = everything(world);
  const auto belief = world.belief();
  for (const Fault& fault : faults()) {
    SCOPED_TRACE(fault.name);
    const auto refused = world.apply(fault.event);
    ASSERT_FALSE(refused.ok());
    EXPECT_TRUE(refused.error().field.starts_with(fault.field)) << refused.error().text();
    EXPECT_EQ(refused.error().code, fault.code) << refused.error().text();
    EXPECT_FALSE(refused.error().message.empty());
    EXPECT_FALSE(world.check(fault.event).ok());
    EXPECT_EQ(world.belief(), belief);
    EXPECT_EQ(everything(world), before);
  }
}

TEST(EventRefusal, LeavesNoTraceInWhatFollows) {
  World world(small_world()), other(small_world());
  for (World* w : {&world, &other}) prepare(*w);
  for (const Fault& fault : faults()) EXPECT_FALSE(world.apply(fault.event).ok()) << fault.name;
  for (World* w : {&world, &other}) {
    EXPECT_EQ(apply(*w, kMoved), 4);
    apply(*w, {frame(1.2, {at(1, 1)})});
  }
  EXPECT_EQ(everything(world), everything(other));
}

TEST(EventRefusal, TheEdgesOfWhatIsTaken) {
  const auto takes = [](const Event& e) {
    World world(small_world());
    prepare(world);
    return world.apply(e).ok();
  };
  EXPECT_TRUE(takes(kMoved));
  EXPECT_TRUE(takes(event(Kind::kMoved, 0.5, "cup-1"))) << "late, after the object's first frame";
  EXPECT_TRUE(takes(event(Kind::kRemoved, 1e8, "cup-1"))) << "a clock three years ahead";
  EXPECT_TRUE(takes(named(1, "cup-1", std::string(128, 'a'))));
  EXPECT_TRUE(takes(named(1, "mug", "mug")));
  EXPECT_TRUE(takes(undone(1, 3)));
  EXPECT_TRUE(takes(looked_at([](auto&) {})));
  EXPECT_TRUE(takes(looked_at_box([](auto& r) { r.z = {3, 0}; }))) << "no heights in a 2-D world";
}

}  // namespace
}  // namespace anchord
