#include "experiments/soak/lines.h"

#include <anchord/query_t.hpp>

#include "api/frame_json.h"
#include "lcmtypes/codec.h"
#include "lcmtypes/verification_codec.h"

namespace anchord::experiment {
namespace {

using Json = nlohmann::json;

constexpr Utime kStart = 1'700'000'000'000'000;  // fixed: the same frames again, in November 2023
constexpr Utime kQuarter = 250'000;              // us

std::string hex(const std::vector<std::uint8_t>& bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

std::string line(Utime utime, const char* what, Json value) {
  Json out{{"utime", utime}};
  out[what] = std::move(value);
  return out.dump();
}

}  // namespace

std::string HomeLines::header() {
  std::vector<std::uint8_t> bytes = encode_message(query_t{});
  bytes.resize(8);
  return Json{{"query", hex(bytes)}}.dump();
}

HomeLines::HomeLines(const Knowledge& knowledge, std::uint64_t seed)
    : knowledge_(knowledge),
      site_(knowledge),
      home_(knowledge, site_, 2 * seed),
      watch_(knowledge, site_, 2 * seed + 1) {}

std::vector<std::string> HomeLines::next() {
  ++quarter_;
  home_.step(1e-6 * kQuarter);
  watch_.step(1e-6 * kQuarter);
  const Utime utime = kStart + quarter_ * kQuarter;
  std::vector<std::string> lines{line(utime, "frame", to_json(watch_.robot_camera(home_, utime)))};
  if (quarter_ % 4 != 0) return lines;
  // Not at the same instant: two frames of one instant would stand in the order of acceptance.
  const Frame hall = watch_.hall_camera(home_, utime + 1000);
  lines.push_back(Json{
      {"utime", hall.utime}, {"frame", to_json(hall)}, {"lcm", hex(encode(hall, quarter_ / 4))}}
                      .dump());
  RobotPose robot;
  robot.utime = utime + 2000;
  robot.pose = watch_.base().pose();
  lines.push_back(line(robot.utime, "pose", hex(encode(robot))));
  if (quarter_ % 40 == 0) lines.push_back(truth(utime + 3000));
  return lines;
}

std::string HomeLines::truth(Utime utime) const {
  Json objects = Json::array();
  const auto add = [&](int object_class, const Eigen::Vector3d& at) {
    objects.push_back({knowledge_.classes[static_cast<std::size_t>(object_class)].name,
                       {at.x(), at.y(), at.z()}});
  };
  for (const HomeThing& thing : home_.things())
    if (thing.here()) add(thing.object_class, thing.position);
  for (const Dweller& dweller : home_.dwellers())
    if (dweller.here)
      add(dweller.object_class, {dweller.position.x(), dweller.position.y(), dweller.height});
  return line(utime, "truth", std::move(objects));
}

}  // namespace anchord::experiment
