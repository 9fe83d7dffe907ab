#include "tests/anchoring/random_looks.h"

namespace anchord::enumeration {
namespace {

/// A class that is no phantom; at most one is.
int some_look(const Knowledge& knowledge, Dice& dice) {
  const int n = static_cast<int>(knowledge.classes.size());
  const int first = dice.integer(0, n - 1);
  return knowledge.classes[first].phantom ? (first + 1) % n : first;
}

}  // namespace

void add_looks(Knowledge& knowledge, Dice& dice) {
  for (ObjectClass& c : knowledge.classes)
    if (c.phantom && dice.chance(0.8)) c.looks_like = some_look(knowledge, dice);
  const auto look = [&](Sensor& sensor) {
    if (dice.chance(0.7)) {
      sensor.clutter_looks.assign(knowledge.classes.size(), 0);
      const double share = dice.uniform(0, 1);
      sensor.clutter_looks[some_look(knowledge, dice)] += share;
      sensor.clutter_looks[some_look(knowledge, dice)] += 1 - share;
    }
    if (dice.chance(0.5))
      for (std::size_t c = 0; c < knowledge.classes.size(); ++c)
        sensor.score_calibration.of.push_back(
            {dice.uniform(-1, 1), dice.uniform(0.5, 1.5), dice.uniform(-0.2, 0.2)});
    if (dice.chance(0.7))
      for (std::size_t c = 0; c < knowledge.classes.size(); ++c)
        sensor.real_share.of.push_back(dice.uniform(0.2, 0.9));
  };
  look(knowledge.default_sensor);
  for (Sensor& sensor : knowledge.sensors) look(sensor);
}

}  // namespace anchord::enumeration
