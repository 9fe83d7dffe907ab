#include "experiments/anchoring/cups.h"

#include "experiments/anchoring/watching.h"

namespace anchord::experiment {
namespace {

constexpr double kStep = 0.1;                                        // s
constexpr double kHidden = 4, kPartial = 9, kAfter = 13, kEnd = 18;  // s, when each part begins
constexpr double kDetectionProbability = 0.9, kFalsePositives = 0.01, kLabel = 0.8;
constexpr double kNear = 0.1;  // m: under 4 deviations of one measurement, less than between cups

const std::vector<std::string> kLabels{"cup", "tea_can", "tea_box"};

struct Stander {
  std::string object_class;
  Eigen::Vector2d position;
};

const Stander kCup{"cup", {0.35, 0.5}}, kSecond{"cup", {0.8, 0.35}};
const std::vector<Stander> kOthers{{"tea_can", {0.3, 0.2}}, {"tea_box", {0.55, 0.6}}};

std::string part_of(double time) {
  if (time < kHidden) return "before";
  if (time < kPartial) return "hidden";
  return time < kAfter ? "partial" : "after";
}

AttributeReport class_of(const std::string& object_class, Dice& dice) {
  std::vector<std::string> others;
  for (const std::string& l : kLabels)
    if (l != object_class) others.push_back(l);
  return label("class", object_class, others, kLabel, dice);
}

}  // namespace

Eigen::Vector2d second_cup() { return kSecond.position; }

std::vector<CupsShot> simulate_cups(Dice& dice) {
  Camera camera("camera", kDetectionProbability, kFalsePositives, dice);
  std::vector<CupsShot> shots;
  for (int k = 0; k * kStep < kEnd - kStep / 2; ++k) {
    CupsShot shot{k * kStep + kStep / 2, "", {}};
    shot.part = part_of(shot.time);
    std::optional<Rectangle> seen = table();
    if (shot.part == "hidden") seen.reset();
    if (shot.part == "partial") seen->low.x() = 0.68;
    shot.frame = camera.frame(shot.time, seen);
    std::vector<Stander> there = kOthers;
    there.push_back(kCup);
    if (shot.time > kPartial) there.push_back(kSecond);
    for (const Stander& s : there) {
      if (!seen || !seen->contains(s.position)) continue;
      auto detection = camera.look(s.position);
      if (!detection) continue;
      detection->attributes.push_back(class_of(s.object_class, dice));
      shot.frame.detections.push_back(std::move(*detection));
    }
    if (seen)
      for (Detection& detection : camera.false_positives(*seen)) {
        const auto any = static_cast<std::size_t>(dice.uniform(0, 3));
        detection.attributes.push_back({"class", SymbolReport{{{kLabels[any], kLabel}}}});
        shot.frame.detections.push_back(std::move(detection));
      }
    shots.push_back(std::move(shot));
  }
  return shots;
}

std::vector<CupsBelief> watch_cups(const Knowledge& knowledge, const std::vector<CupsShot>& shots) {
  World world(knowledge);
  std::uint64_t known = 0;
  std::vector<CupsBelief> beliefs;
  for (const CupsShot& shot : shots) {
    take(world, shot.frame);
    const std::vector<Shown> shown = best_world(*world.belief());
    const Shown* at_home = nearest(shown, kCup.position, kNear);
    const Shown* at_second = nearest(shown, kSecond.position, kNear);
    if (shot.part == "before" && at_home) known = at_home->birth;
    CupsBelief& belief = beliefs.emplace_back();
    for (const std::uint64_t anchor : anchors(*world.belief()))
      (anchor == known ? belief.moved : belief.new_cup) +=
          probability_of(*world.belief(), {{anchor, kSecond.position}}, kNear);
    belief.one_cup = at_second && at_second->birth == known;
    belief.two_cups = at_second && at_home && at_home->birth == known;
  }
  return beliefs;
}

}  // namespace anchord::experiment
