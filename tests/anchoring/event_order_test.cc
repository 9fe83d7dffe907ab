// Events among frames that arrive late against each other.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <variant>

#include "tests/anchoring/dice.h"
#include "tests/anchoring/random_scene.h"
#include "tests/anchoring/small_events.h"

namespace anchord {
namespace {

using enumeration::Dice;
using Kind = Event::Kind;
using Input = std::variant<Frame, Event>;

struct Fold {
  std::string belief;
  std::uint64_t late = 0;  ///< frames and events
  int refused = 0;         ///< events
};

Utime time_of(const Input& input) {
  return std::visit([](const auto& one) { return one.utime; }, input);
}

Fold folded(const Knowledge& knowledge, const std::vector<Input>& inputs,
            const std::vector<std::size_t>& order) {
  World world(knowledge);
  Fold fold;
  for (const std::size_t i : order) {
    fold.late += time_of(inputs[i]) < world.belief()->utime ? 1 : 0;
    if (const auto* frame = std::get_if<Frame>(&inputs[i]))
      apply(world, {*frame});
    else if (!world.apply(std::get<Event>(inputs[i])).ok())
      ++fold.refused;
  }
  fold.belief = everything(world);
  return fold;
}

std::vector<std::size_t> in_order(std::size_t n) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

std::vector<std::size_t> by(const std::vector<double>& arrival) {
  auto order = in_order(arrival.size());
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return arrival[a] < arrival[b]; });
  return order;
}

/// Anything but an undo, whose number hangs on the order of acceptance.
Event random_event(Dice& dice, double seconds, const std::vector<std::string>& names) {
  const auto kind = static_cast<Kind>(dice.integer(0, static_cast<int>(Kind::kDropped)));
  // What ends an object, less often.
  if ((kind == Kind::kRemoved || kind >= Kind::kJoined) && dice.chance(0.7))
    return random_event(dice, seconds, names);
  const std::string object = dice.pick(names);
  const double x = dice.uniform(0, 6), y = dice.uniform(0, 4);
  Event e = event(kind, seconds, kind == Kind::kCarried ? "" : object);
  if (kind == Kind::kMissing)
    return missing(seconds, object, box_of_interest(x - 0.5, y - 0.5, x + 0.5, y + 0.5));
  if (kind == Kind::kNamed) e.other = dice.pick<std::string>({"", "mug", "jar"});
  if (kind == Kind::kJoined) e.other = dice.pick(names);
  if (kind == Kind::kCarried || dice.chance(0.3)) e.position = {x, y, 0};
  if ((kind == Kind::kPlaced || kind == Kind::kMoved) && dice.chance(0.5))
    e.place = dice.pick<std::string>({"kitchen", "table", "hall"});
  return e;
}

constexpr const char* kMoving = R"({"classes": {"default": {"models": [
    {"kind": "constant_velocity", "acceleration_psd": 0.1, "initial_velocity_variance": 0.1},
    {"kind": "somewhere", "place": "kitchen", "rate": 0.02}]}}})";

/// Three sensors over objects that are known from the start, and events about them.
std::vector<Input> random_inputs(Dice& dice, int objects, int steps) {
  std::vector<Input> inputs;
  std::vector<Detection> first;
  std::vector<std::string> names;
  for (int o = 0; o < objects; ++o) {
    first.push_back(at(1 + 1.5 * o, 1 + 0.4 * o, 0.0025));
    names.push_back("cup-" + std::to_string(o + 1));
  }
  inputs.emplace_back(frame(0, first, "left"));
  for (int step = 0; step < steps; ++step) {
    for (const char* sensor : {"left", "right", "top"}) {
      if (dice.chance(0.4)) continue;
      std::vector<Detection> detections;
      for (int o = 0; o < objects; ++o)
        if (dice.chance(0.8))
          detections.push_back(
              at(1 + 1.5 * o + 0.05 * dice.normal(), 1 + 0.4 * o + 0.05 * dice.normal(), 0.0025));
      inputs.emplace_back(frame(0.1 + step * 0.1 + dice.uniform(0, 0.09), detections, sensor));
    }
    if (dice.chance(0.6))
      inputs.emplace_back(random_event(dice, 0.1 + step * 0.1 + dice.uniform(0, 0.09), names));
  }
  std::stable_sort(inputs.begin(), inputs.end(),
                   [](const Input& a, const Input& b) { return time_of(a) < time_of(b); });
  return inputs;
}

/// When each arrives: up to 0.2 s late, those of one sensor in order; and so two events, which say
/// what they say of what was said before.
std::vector<double> random_arrival(Dice& dice, const std::vector<Input>& inputs) {
  std::vector<double> arrival;
  std::map<std::string, double> last;
  for (const Input& input : inputs) {
    const auto* f = std::get_if<Frame>(&input);
    double& newest = last[f ? f->sensor : "events"];
    const double late = time_of(input) == at_second(0) ? 0 : dice.uniform(0, 0.2);
    newest = std::max(static_cast<double>(time_of(input)) * 1e-6 + late, newest + 1e-6);
    arrival.push_back(newest);
  }
  return arrival;
}

TEST(EventOrder, AnyArrivalWithinTheLatenessIsTheSame) {
  std::uint64_t late = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    std::mt19937_64 random(seed);
    Dice dice(random);
    const auto inputs = random_inputs(dice, 3, 15);
    const auto order = by(random_arrival(dice, inputs));
    const Knowledge knowledge = small_world(seed % 2 == 0 ? kMoving : "{}");
    const Fold shuffled = folded(knowledge, inputs, order);
    const Fold straight = folded(knowledge, inputs, in_order(inputs.size()));
    EXPECT_TRUE(shuffled.belief == straight.belief) << "seed " << seed;
    late += shuffled.late;
    refused += straight.refused;
  }
  EXPECT_GT(late, 300u);
  EXPECT_GT(refused, 5u) << "about what is gone by then";
}

TEST(EventOrder, WithoutLimitsToo) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    std::mt19937_64 random(seed);
    Dice dice(random);
    auto inputs = random_inputs(dice, 2, 3);
    inputs.resize(std::min<std::size_t>(inputs.size(), 5));
    const auto order = by(random_arrival(dice, inputs));
    const Knowledge knowledge = small_world(kExact);
    EXPECT_TRUE(folded(knowledge, inputs, order).belief ==
                folded(knowledge, inputs, in_order(inputs.size())).belief)
        << "seed " << seed;
  }
}

TEST(EventOrder, RandomScenesWithEvents) {
  int events = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    std::mt19937_64 random(seed);
    Dice dice(random);
    enumeration::Variety variety = enumeration::random_variety(random);
    variety.sensors = variety.late = true;
    variety.verification = variety.three_d = false;
    const auto scene = enumeration::random_scene(random, variety);
    // In order, with an event after a frame about what is believed by then.
    World world(scene.knowledge);
    std::vector<Input> inputs;
    std::vector<std::size_t> at_frame;  // per frame: its index among the inputs
    std::vector<std::size_t> after;     // per event: the frame that it follows
    std::vector<std::size_t> event_index;
    for (std::size_t f = 0; f < scene.frames.size(); ++f) {
      at_frame.push_back(inputs.size());
      inputs.emplace_back(scene.frames[f]);
      apply(world, {scene.frames[f]});
      const bool last =
          f + 1 == scene.frames.size() || scene.frames[f + 1].utime > scene.frames[f].utime + 1;
      const auto names = ids(world);
      if (!last || names.empty()) continue;
      Event e = random_event(dice, 0, names);
      e.place.clear();
      e.utime = scene.frames[f].utime + 1;
      if (!world.apply(e).ok()) continue;
      event_index.push_back(inputs.size());
      after.push_back(f);
      inputs.emplace_back(e);
      ++events;
    }
    // As the frames arrive; an event once all frames before it are there.
    std::vector<std::size_t> order;
    std::vector<char> here(scene.frames.size(), 0);
    std::size_t next = 0;
    for (const std::size_t f : scene.arrival) {
      order.push_back(at_frame[f]);
      here[f] = 1;
      while (next < after.size() &&
             std::all_of(here.begin(), here.begin() + static_cast<std::ptrdiff_t>(after[next]) + 1,
                         [](char h) { return h != 0; }))
        order.push_back(event_index[next++]);
    }
    const Fold shuffled = folded(scene.knowledge, inputs, order);
    EXPECT_TRUE(shuffled.belief == everything(world)) << "seed " << seed;
    EXPECT_EQ(shuffled.refused, 0);
  }
  EXPECT_GT(events, 50);
}

TEST(EventOrder, AReplayGivesTheSameBytes) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    std::mt19937_64 random(seed), same(seed);
    Dice dice(random), again(same);
    const auto inputs = random_inputs(dice, 3, 15);
    const auto order = by(random_arrival(dice, inputs));
    const auto inputs_again = random_inputs(again, 3, 15);
    EXPECT_TRUE(folded(small_world(kMoving), inputs, order).belief ==
                folded(small_world(kMoving), inputs_again, order).belief);
  }
}

TEST(EventOrder, AnEventAheadMakesNoFrameLate) {
  for (const double ahead : {0.3, 1e6}) {
    World world(small_world()), other(small_world());
    for (World* w : {&world, &other}) apply(*w, {frame(1, {at(1, 1)}, "left")});
    apply(world, at_position(event(Kind::kMoved, 1 + ahead, "cup-1"), 4, 2));
    apply(other, at_position(event(Kind::kMoved, 1, "cup-1"), 4, 2));
    EXPECT_EQ(everything(world), everything(other));
    const std::vector<Frame> next{frame(0.8, {at(1, 1)}, "right"), frame(1.01, {}, "right"),
                                  frame(2, {at(4, 2)}, "left")};
    for (World* w : {&world, &other}) apply(*w, next);
    EXPECT_EQ(world.late_frames(), 1u) << "that of 0.8 s";
    EXPECT_EQ(other.late_frames(), 1u);
  }
}

TEST(EventOrder, AnEventThatIsAheadStandsAfterTheFramesBeforeIt) {
  World world(small_world());
  apply(world, {frame(1, {at(1, 1)}, "left")});
  apply(world, event(Kind::kRemoved, 1.3, "cup-1"));
  EXPECT_TRUE(objects(world).empty());
  apply(world, {frame(1.2, {at(1, 1)}, "right")});
  EXPECT_FALSE(find_anchor(*world.belief(), "cup-1")) << "seen before it was removed";
  EXPECT_TRUE(objects(world).empty() || objects(world)[0].p < 0.01);
}

TEST(EventOrder, AnotherClocksEventsStayInTheirOrder) {
  World world(small_world());
  apply(world, {frame(1, {at(1, 1)})});
  apply(world, event(Kind::kGrasped, 1.2, "cup-1"));
  apply(world, event(Kind::kPlaced, 1e6, "cup-1"));  // 12 days ahead
  EXPECT_FALSE(find(world, "cup-1").anchor->holder);
}

TEST(EventOrder, ALateFrameMayTakeAwayWhatAnEventWasAbout) {
  // The anchor that is grasped is the second by name only until the late frame bears another.
  World world(small_world());
  apply(world, {frame(1, {at(1, 1)}, "left")});
  const auto number = apply(world, event(Kind::kDropped, 1, "cup-1"));
  apply(world, {frame(0.9, {at(4, 2)}, "right")});
  World other(small_world());
  apply(other, {frame(0.9, {at(4, 2)}, "right"), frame(1, {at(1, 1)}, "left")});
  apply(other, event(Kind::kDropped, 1, "cup-1"));
  EXPECT_EQ(everything(world), everything(other));
  apply(world, undone(1, number));
  EXPECT_EQ(ids(world), (std::vector<std::string>{"cup-1", "cup-2"}));
}

}  // namespace
}  // namespace anchord
