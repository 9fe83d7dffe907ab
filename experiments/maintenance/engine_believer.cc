#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "anchoring/world.h"
#include "experiments/maintenance/believer.h"
#include "maintenance/entropy.h"

namespace anchord::experiment {
namespace {

constexpr Utime kStart = 1'700'000'000'000'000;  // any time that a frame may carry
constexpr double kLeastExistence = 0.1;          // of an anchor that is counted or looked for

class Engine : public Believer {
 public:
  Engine(const Scene& scene, const Site& site, Dice& dice) : site_(site), world_(scene.knowledge) {
    // Somebody has shown all things at the start.
    Frame frame;
    frame.utime = kStart;
    frame.sensor = "eye";
    frame.view.emplace().type = View::Type::kWorld;
    const double v = scene.initial_variance;
    for (const Thing& thing : scene.things) {
      Detection detection = report(thing.object_class, 0.98);
      const double x = thing.position.x() + std::sqrt(v) * dice.normal();
      detection.measurement = CartesianMeasurement{
          {x, thing.position.y() + std::sqrt(v) * dice.normal()}, {v, 0, 0, v}};
      detection.score = 1 - 1e-6;
      frame.detections.push_back(std::move(detection));
    }
    apply(frame);
  }

  void take(const Look& look, double time) override {
    Frame frame;
    frame.utime = kStart + from_seconds(time);
    frame.sensor = site_.sensor_names[static_cast<std::size_t>(look.eye)];
    frame.pose = look.base.pose();  // the eye is over the middle of the base
    const double c = std::cos(look.base.yaw), s = std::sin(look.base.yaw);
    for (const Look::Seen& seen : look.seen) {
      Detection detection = report(seen.object_class, 0.9);
      const Eigen::Vector2d d = seen.position - look.base.position;
      detection.measurement =
          CartesianMeasurement{{c * d.x() + s * d.y(), c * d.y() - s * d.x()}, {}};
      frame.detections.push_back(std::move(detection));
    }
    apply(frame);
  }

  std::vector<Subject> subjects(double time) override {
    return read_subjects(*world_.belief(), kStart + from_seconds(time), kLeastExistence,
                         *world_.background());
  }

  Entropies entropies(double time) override {
    const BeliefEntropy all = entropy(*world_.belief(), kStart + from_seconds(time),
                                      kLeastExistence, *world_.background());
    return {all.max, all.sum};
  }

 private:
  Detection report(int object_class, double probability) const {
    Detection detection;
    const Knowledge& knowledge = world_.background()->knowledge;
    const std::string& name = knowledge.classes[static_cast<std::size_t>(object_class)].name;
    detection.attributes.push_back({"class", SymbolReport{{{name, probability}}}});
    return detection;
  }

  void apply(const Frame& frame) {
    const Status status = world_.apply(frame);
    if (status.ok()) return;
    std::fprintf(stderr, "the engine refused a frame: %s\n", status.error().text().c_str());
    std::abort();
  }

  const Site& site_;
  World world_;
};

}  // namespace

std::unique_ptr<Believer> engine_believer(const Scene& scene, const Site& site, Dice& dice) {
  return std::make_unique<Engine>(scene, site, dice);
}

}  // namespace anchord::experiment
