#include "experiments/anchoring/hidden.h"

#include <cmath>
#include <utility>

#include "experiments/anchoring/watching.h"

namespace anchord::experiment {
namespace {

constexpr double kStep = 0.05;                            // s
constexpr double kKnown = 3, kCarried = 1, kSettled = 2;  // s that parts last
constexpr double kDetectionProbability = 0.9, kColorIsRight = 0.8;
constexpr double kNear = 0.1;     // m: under 4 deviations of one measurement
constexpr double kBeside = 0.07;  // m between cups that touch: 2.5 deviations
const Rectangle kBetween{{0.48, 0}, {0.72, 0.8}};

/// How far places differ from scene to scene, m.
Eigen::Vector2d about(double x, double y, Dice& dice) {
  return {x + dice.uniform(-0.03, 0.03), y + dice.uniform(-0.2, 0.2)};
}

class Recorder {
 public:
  Recorder(const HiddenScene& scene, Dice& dice)
      : camera_(scene.false_positives > 0 ? "cluttered" : "camera", kDetectionProbability,
                scene.false_positives, dice),
        dice_(dice) {}

  /// Records for some seconds.
  void record(double seconds, const std::optional<Rectangle>& seen,
              const std::array<Eigen::Vector2d, 2>& cups, bool colors) {
    const auto frames = std::max(1L, std::lround(seconds / kStep));
    for (long k = 0; k < frames; ++k, ++count_) {
      Frame frame = camera_.frame(static_cast<double>(count_) * kStep, seen);
      for (std::size_t i = 0; seen && i < cups.size(); ++i) {
        if (!seen->contains(cups[i])) continue;
        auto detection = camera_.look(cups[i]);
        if (!detection) continue;
        const char* names[]{"red", "blue"};
        if (colors)
          detection->attributes.push_back(
              label("color", names[i], {names[1 - i]}, kColorIsRight, dice_));
        frame.detections.push_back(std::move(*detection));
      }
      if (seen)
        for (Detection& detection : camera_.false_positives(*seen))
          frame.detections.push_back(std::move(detection));
      if (dice_.happens(0.5) && frame.detections.size() > 1)
        std::swap(frame.detections.front(), frame.detections.back());
      frames_.push_back(std::move(frame));
    }
  }

  std::size_t count() const { return frames_.size(); }
  std::vector<Frame> frames() { return std::move(frames_); }

 private:
  Camera camera_;
  Dice& dice_;
  long count_ = 0;
  std::vector<Frame> frames_;
};

}  // namespace

HiddenFootage simulate_hidden(const HiddenScene& scene, Dice& dice) {
  HiddenFootage footage;
  footage.from = {about(0.35, 0.4, dice), about(0.85, 0.4, dice)};
  footage.to = footage.from;
  const bool beside = scene.ambiguity == Ambiguity::kSideBySide;
  const bool colors = beside || scene.ambiguity == Ambiguity::kNoColor;
  footage.near = beside ? kBeside / 2 : kNear;
  if (colors) {
    footage.to = {about(0.2, 0.4, dice), about(0.6, 0.4, dice)};
    if (beside) footage.to[1] = footage.to[0] + Eigen::Vector2d(kBeside, 0);
    if (dice.happens(0.5)) std::swap(footage.to[0], footage.to[1]);
  } else {
    footage.to[dice.happens(0.5) ? 1 : 0] = about(0.6, 0.4, dice);
  }
  Recorder recorder(scene, dice);
  recorder.record(kKnown, table(), footage.from, colors);
  footage.known = recorder.count();
  if (scene.ambiguity == Ambiguity::kHidden) {
    recorder.record(scene.seconds, std::nullopt, footage.to, false);
  } else {
    recorder.record(kCarried, std::nullopt, footage.to, false);
    recorder.record(scene.seconds, colors ? table() : kBetween, footage.to, false);
  }
  footage.settled = recorder.count();
  recorder.record(kSettled, table(), footage.to, colors);
  footage.frames = recorder.frames();
  return footage;
}

HiddenOutcome watch_hidden(const Knowledge& knowledge, const HiddenFootage& footage) {
  World world(knowledge);
  HiddenOutcome outcome;
  std::vector<Standing> truth;
  for (std::size_t k = 0; k < footage.frames.size(); ++k) {
    take(world, footage.frames[k]);
    if (k + 1 == footage.known) {
      const std::vector<Shown> shown = best_world(*world.belief());
      for (std::size_t i = 0; i < 2; ++i)
        if (const Shown* cup = nearest(shown, footage.from[i], kNear))
          truth.push_back({cup->birth, footage.to[i]});
      if (truth.size() < 2) return outcome;
    }
    if (k + 1 == footage.settled)
      outcome.kept = probability_of(*world.belief(), truth, footage.near);
  }
  outcome.probability = probability_of(*world.belief(), truth, footage.near);
  const std::vector<Shown> shown = best_world(*world.belief());
  outcome.right = true;
  for (const Standing& standing : truth) {
    const Shown* there = nearest(shown, standing.place, footage.near);
    outcome.right = outcome.right && there && there->birth == standing.birth;
  }
  return outcome;
}

}  // namespace anchord::experiment
