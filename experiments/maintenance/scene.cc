#include "experiments/maintenance/scene.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "knowledge/configuration.h"

namespace anchord::experiment {
namespace {

constexpr double kPi = 3.141592653589793;

Knowledge read(const std::string& text) {
  const Configuration configuration = parse_configuration(text);
  for (const auto& mistake : configuration.mistakes())
    std::fprintf(stderr, "%s\n", mistake.text().c_str());
  if (!configuration.ok()) std::abort();
  return configuration.knowledge();
}

/// A sensor with a sector view, as configured.
std::string sensor(const std::string& name, double low, double high, double half_width,
                   double variance, const std::string& verification, double clutter, int dims) {
  const std::string v = std::to_string(variance);
  const std::string noise =
      dims == 2 ? "[" + v + ",0,0," + v + "]" : "[" + v + ",0,0,0," + v + ",0,0,0," + v + "]";
  return "\"" + name + R"(": {"view": {"type": "sector", "range": [)" + std::to_string(low) + "," +
         std::to_string(high) + R"(], "bearing": [)" + std::to_string(-half_width) + "," +
         std::to_string(half_width) + R"(]}, "noise": )" + noise + R"(, "clutter_density": )" +
         std::to_string(clutter) + R"(, "verification": {)" + verification + "}}";
}

std::string bounds(double x, double y, int dims, const std::string& walls = "[]") {
  const std::string low = dims == 2 ? "[0, 0]" : "[0, 0, -1]";
  const std::string high =
      "[" + std::to_string(x) + "," + std::to_string(y) + (dims == 2 ? "]" : ",1]");
  return R"("world": {"dimensions": )" + std::to_string(dims) + R"(, "bounds": {"min": )" + low +
         R"(, "max": )" + high + R"(}, "cell": 0.5, "walls": )" + walls + "}";
}

}  // namespace

Scene thesis_room(const RoomOptions& options, Dice& dice) {
  Scene scene;
  scene.knowledge =
      read("{" + bounds(10, 10, options.dims) +
           R"(, "attributes": {"class": {"kind": "categorical", "symbols": ["thing"]}},
               "classes": {"thing": {"models": [{"kind": "constant_position",
                                                 "position_psd": 0.005}],
                                     "detection_probability": 0.999}},
               "sensors": {)" +
           sensor("eye", 0.4, 2, options.half_width, 0.01, R"("dwell": 0)", 1e-3, options.dims) +
           R"(}, "maintenance": {"omega": 0.75, "gain_norm": 5, "cost_scale": 10}})");
  scene.knowledge.maintenance.step = options.step;
  scene.knowledge.maintenance.speed = options.speed;
  // Thesis: everything in view is measured. What is configured must be below 1.
  for (Sensor& each : scene.knowledge.sensors) each.detection_probability.assign(1, 1.0);
  scene.rooms = {{{0, 0}, {10, 10}}};
  scene.start = {5, 5};
  for (int i = 0; i < options.things; ++i) {
    Thing thing;
    thing.position = scene.rooms[0].draw(dice);
    thing.psd = dice.uniform(0, options.most_psd);
    scene.things.push_back(thing);
  }
  return scene;
}

Scene unreliable_room(Dice& dice) {
  Scene scene;
  const double psds[] = {0.001, 0.004, 0.01};
  std::string classes, symbols;
  for (int c = 0; c < 3; ++c) {
    const std::string name = "kind" + std::to_string(c), comma = c ? "," : "";
    symbols += comma + "\"" + name + "\"";
    classes += comma + "\"" + name +
               R"(": {"models": [{"kind": "constant_position", "position_psd": )" +
               std::to_string(psds[c]) +
               R"(}, {"kind": "somewhere", "rate": 0.002}], "detection_probability": 0.8,
                  "undetected_intensity": 0.001, "arrival_rate": 1e-8, "departure_rate": 1e-6})";
  }
  scene.knowledge =
      read("{" + bounds(10, 10, 2) +
           R"(, "attributes": {"class": {"kind": "categorical", "symbols": [)" + symbols +
           R"(]}}, "classes": {)" + classes + R"(}, "sensors": {)" +
           sensor("eye", 0.4, 2, kPi, 0.01, R"("dwell": 0)", 0.005, 2) +
           R"(}, "maintenance": {"omega": 0.75, "gain_norm": 5, "cost_scale": 10, "step": 1,
                      "speed": 1}})");
  scene.rooms = {{{0, 0}, {10, 10}}};
  scene.start = {5, 5};
  scene.wanders = true;
  scene.jump_rate = 0.002;
  scene.engine = true;
  for (int i = 0; i < 10; ++i)
    scene.things.push_back({scene.rooms[0].draw(dice), i % 3, psds[i % 3]});
  return scene;
}

Scene house(double most_psd, Dice& dice) {
  Scene scene;
  // Two rooms above, three below, and doors of 1 m.
  const std::string walls = R"([
      [[0, 6], [2.5, 6]], [[3.5, 6], [8.5, 6]], [[9.5, 6], [14.5, 6]], [[15.5, 6], [18, 6]],
      [[6, 0], [6, 2.5]], [[6, 3.5], [6, 6]], [[12, 0], [12, 2.5]], [[12, 3.5], [12, 6]],
      [[9, 6], [9, 6.6]], [[9, 7.6], [9, 12]]])";
  scene.knowledge =
      read("{" + bounds(18, 12, 2, walls) +
           R"(, "attributes": {"class": {"kind": "categorical", "symbols": ["thing"]}},
               "classes": {"thing": {"models": [{"kind": "constant_position",
                                                 "position_psd": 0.005}],
                                     "detection_probability": 0.9}},
               "sensors": {)" +
           sensor("far", 0.5, 5, kPi / 4, 0.09, R"("dwell": 0)", 1e-3, 2) + "," +
           sensor("near", 0.3, 1.5, kPi / 4, 0.0025, R"("dwell": 2, "cost": 0.1)", 1e-3, 2) +
           R"(}, "maintenance": {"gain_norm": 5, "cost_scale": 18, "step": 1, "speed": 0.5}})");
  const double off = 0.4;  // m that things stand off walls
  const double corners[][4] = {
      {0, 0, 6, 6}, {6, 0, 12, 6}, {12, 0, 18, 6}, {0, 6, 9, 12}, {9, 6, 18, 12}};
  for (const auto& c : corners)
    scene.rooms.push_back({{c[0] + off, c[1] + off}, {c[2] - off, c[3] - off}});
  scene.start = {8.5, 3};
  scene.patrol = {{3, 3}, {9, 3}, {15, 3}, {13.5, 8.5}, {4.5, 8.5}};
  scene.wanders = true;
  for (int i = 0; i < 40; ++i)
    scene.things.push_back(
        {scene.rooms[static_cast<std::size_t>(i % 5)].draw(dice), 0, dice.uniform(0, most_psd)});
  return scene;
}

}  // namespace anchord::experiment
