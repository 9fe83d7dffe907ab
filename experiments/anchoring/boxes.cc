#include "experiments/anchoring/boxes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "anchoring/reading.h"
#include "experiments/anchoring/watching.h"

namespace anchord::experiment {
namespace {

constexpr double kStep = 0.1;  // s
// s, when each part begins; in the last second of `added` and the first of `parted` a box is moved.
constexpr double kHidden = 8, kCup = 12, kAdded = 18, kTouching = 28, kParted = 38, kEnd = 46;
constexpr double kPush = 2;       // s that a box is pushed
constexpr double kSwitching = 1;  // 1/s, between two blobs and one
constexpr double kDetectionProbability = 0.8, kFalsePositives = 0.01, kSymbol = 0.8;
constexpr double kEdge = 0.004;  // m, deviation of a measured width or height
constexpr double kNear = 0.1;    // m: under 4 deviations of one measurement

const Blob kLeft{{0.35, 0.55}, 0.15, 0.08, "green"}, kRight{{0.95, 0.6}, 0.18, 0.1, "green"},
    kSmall{{0.6, 0.2}, 0.09, 0.08, "green"}, kRedBox{{0.9, 0.3}, 0.1, 0.075, "red"},
    kRedCup{{0.75, 0.4}, 0.08, 0.09, "red"};

std::string part_of(double time) {
  if (time < kHidden) return "three";
  if (time < kCup) return "hidden";
  if (time < kAdded) return "cup";
  if (time < kTouching) return "added";
  return time < kParted ? "touching" : "parted";
}

/// Where the red box is while it is moved about: once round a circle of 0.1 m.
Eigen::Vector2d moved_about(double time) {
  const double angle = 2 * std::numbers::pi * time / kHidden;
  return kRedBox.position + 0.1 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

/// How far the right box has been pushed towards the left one, 0 to 1.
double pushed(double time) {
  if (time < kTouching) return std::clamp((time - kTouching) / kPush + 1, 0.0, 1.0);
  return std::clamp(1 - (time - kParted) / kPush, 0.0, 1.0);
}

Blob right_box(double time) {
  Blob right = kRight;
  const Eigen::Vector2d beside =
      kLeft.position + Eigen::Vector2d((kLeft.width + kRight.width) / 2, 0);
  right.position += pushed(time) * (beside - right.position);
  return right;
}

/// Both boxes as one blob.
Blob joined(const Blob& a, const Blob& b) {
  return {(a.position + b.position) / 2, a.width + b.width, std::max(a.height, b.height), a.color};
}

AttributeReport symbol(const std::string& attribute, const std::string& measured) {
  return {attribute, SymbolReport{{{measured, kSymbol}}}};
}

/// What the detector says of a blob, beside its position.
void describe(Detection& detection, const Blob& blob, BlobReport report, Dice& dice) {
  Blob measured = blob;
  measured.width += kEdge * dice.normal();
  measured.height += kEdge * dice.normal();
  const double size = measured.diagonal(), ratio = measured.ratio();
  detection.attributes.push_back(symbol("color", blob.color));
  if (report == BlobReport::kSymbols) {
    detection.attributes.push_back(symbol("size", size_symbol(size)));
    detection.attributes.push_back(symbol("shape", shape_symbol(ratio)));
    return;
  }
  const double edge = kEdge * kEdge;  // first order, edges measured independently
  detection.attributes.push_back({"size", ScalarReport{size, edge}});
  detection.attributes.push_back(
      {"ratio",
       ScalarReport{ratio, edge * (1 + ratio * ratio) / (measured.width * measured.width)}});
}

/// Anything that a blob detector may take for an object.
Blob any_blob(Dice& dice) {
  return {
      {}, dice.uniform(0.05, 0.3), dice.uniform(0.05, 0.3), dice.happens(0.5) ? "red" : "green"};
}

}  // namespace

double Blob::diagonal() const { return std::hypot(width, height); }

std::string size_symbol(double diagonal) {
  if (diagonal < 0.15) return "small";
  return diagonal <= 0.25 ? "medium" : "large";
}

std::string shape_symbol(double ratio) {
  return std::abs(ratio - 1) >= 0.4 ? "rectangle" : "square";
}

std::vector<BoxesShot> simulate_boxes(BlobReport report, Dice& dice) {
  Camera camera("camera", kDetectionProbability, kFalsePositives, dice);
  std::vector<BoxesShot> shots;
  bool one_blob = false;
  for (int k = 0; k * kStep < kEnd - kStep / 2; ++k) {
    BoxesShot shot;
    shot.time = (k + 0.5) * kStep;
    shot.part = part_of(shot.time);
    const bool hidden = shot.part == "hidden";
    shot.frame = camera.frame(shot.time, hidden ? std::nullopt : std::optional<Rectangle>(table()));
    if (!hidden) shot.frame.view->type = View::Type::kWorld;  // the table, and around it
    Blob red = shot.time < kCup ? kRedBox : kRedCup;
    if (shot.time < kHidden) red.position = moved_about(shot.time);
    const Blob right = right_box(shot.time);
    shot.truth = {kLeft.position, kSmall.position, red.position, std::nullopt};
    if (shot.time > kAdded) shot.truth[kRightBox] = right.position;
    if (dice.happens(-std::expm1(-kSwitching * kStep))) one_blob = !one_blob;
    shot.one_blob = shot.part == "touching" && one_blob;
    std::vector<Blob> blobs{kSmall, red};
    if (shot.one_blob) {
      blobs.push_back(joined(kLeft, right));
    } else {
      blobs.push_back(kLeft);
      if (shot.truth[kRightBox]) blobs.push_back(right);
    }
    for (const Blob& blob : blobs) {
      if (hidden) continue;
      auto detection = camera.look(blob.position);
      if (!detection) continue;
      describe(*detection, blob, report, dice);
      shot.frame.detections.push_back(std::move(*detection));
    }
    if (!hidden)
      for (Detection& detection : camera.false_positives(table())) {
        describe(detection, any_blob(dice), report, dice);
        shot.frame.detections.push_back(std::move(detection));
      }
    shots.push_back(std::move(shot));
  }
  return shots;
}

std::vector<BoxesBelief> watch_boxes(const Knowledge& knowledge,
                                     const std::vector<BoxesShot>& shots) {
  World world(knowledge);
  Description large;
  for (const auto& [attribute, symbol_of] :
       {std::pair("color", "green"), std::pair("size", "large")}) {
    const int a = knowledge.find_attribute(attribute);
    large.terms.push_back({a, knowledge.attributes[static_cast<std::size_t>(a)].find(symbol_of)});
  }
  std::vector<BoxesBelief> beliefs;
  for (const BoxesShot& shot : shots) {
    take(world, shot.frame);
    const Belief& now = *world.belief();
    BoxesBelief& belief = beliefs.emplace_back();
    const std::vector<Shown> shown = best_world(now);
    belief.shown = static_cast<int>(shown.size());
    belief.one_large = 1 - count_distribution(now, now.utime, large, -1, *world.background())[0];
    for (std::size_t i = 0; i < kBoxesObjects; ++i)
      if (const Shown* there = shot.truth[i] ? nearest(shown, *shot.truth[i], kNear) : nullptr)
        belief.names[i] = there->birth;
  }
  return beliefs;
}

}  // namespace anchord::experiment
