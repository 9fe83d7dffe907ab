#include "api/foxglove.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include "api/foxglove_schemas.h"

namespace anchord::foxglove {
namespace {

using nlohmann::json;

constexpr std::int64_t kSecond = 1'000'000;  // us
constexpr char kMessageData = 1;             // opcode
constexpr double kSize = 0.12;               // m, of a class without an extent
constexpr int kInfo = 2;                     // a log's level

/// Colours that are told apart by those who see fewer of them, too: Okabe and Ito (2008).
constexpr std::array<std::array<double, 3>, 6> kColors{{{0.00, 0.45, 0.70},
                                                        {0.84, 0.37, 0.00},
                                                        {0.00, 0.62, 0.45},
                                                        {0.80, 0.47, 0.65},
                                                        {0.90, 0.62, 0.00},
                                                        {0.34, 0.71, 0.91}}};

json time_of(Utime utime) { return {{"sec", utime / kSecond}, {"nsec", utime % kSecond * 1000}}; }

json vector_of(double x, double y, double z) { return {{"x", x}, {"y", y}, {"z", z}}; }

json point_of(const json& position, double above = 0) {
  const double z = position.size() > 2 ? position[2].get<double>() : 0;
  return vector_of(position[0], position[1], z + above);
}

json quaternion_about_z(double yaw) {
  return {{"x", 0}, {"y", 0}, {"z", std::sin(yaw / 2)}, {"w", std::cos(yaw / 2)}};
}

json color_of(const std::string& name, double opacity) {
  const auto& [r, g, b] = kColors[std::hash<std::string>{}(name) % kColors.size()];
  return {{"r", r}, {"g", g}, {"b", b}, {"a", opacity}};
}

json entity_of(const std::string& id, const json& object, Utime utime, const std::string& frame) {
  const double p = object["p"], somewhere = object.value("somewhere", 0.0);
  const json color = color_of(object["class"], somewhere >= 0.5 ? 0.15 : 0.3 + 0.7 * p);
  const json pose{{"position", point_of(object["position"])},
                  {"orientation", quaternion_about_z(object.value("yaw", 0.0))}};
  json cubes = json::array(), spheres = json::array();
  double height = kSize;
  if (object.contains("extent")) {
    const json& extent = object["extent"];
    height = extent[2];
    cubes.push_back(
        {{"pose", pose}, {"size", vector_of(extent[0], extent[1], height)}, {"color", color}});
  } else {
    spheres.push_back({{"pose", pose}, {"size", vector_of(kSize, kSize, kSize)}, {"color", color}});
  }
  char text[16];
  std::snprintf(text, sizeof text, " %.2f", p);
  const json name{{"pose",
                   {{"position", point_of(object["position"], height / 2 + 0.1)},
                    {"orientation", quaternion_about_z(0)}}},
                  {"billboard", true},
                  {"font_size", 14},
                  {"scale_invariant", true},
                  {"color", {{"r", 1}, {"g", 1}, {"b", 1}, {"a", 1}}},
                  {"text", object.value("alias", id) + text}};
  json metadata = json::array();
  for (const char* key : {"class", "place"})
    if (object.contains(key)) metadata.push_back({{"key", key}, {"value", object[key]}});
  json entity{{"timestamp", time_of(utime)},
              {"frame_id", frame},
              {"id", id},
              {"lifetime", time_of(0)},
              {"frame_locked", true},
              {"metadata", std::move(metadata)},
              {"cubes", std::move(cubes)},
              {"spheres", std::move(spheres)},
              {"texts", json::array({name})}};
  for (const char* none : {"arrows", "cylinders", "lines", "triangles", "models"})
    entity[none] = json::array();
  return entity;
}

json log_line(Utime utime, const std::string& message) {
  return {{"timestamp", time_of(utime)}, {"level", kInfo}, {"message", message},
          {"name", "anchord"},           {"file", ""},     {"line", 0}};
}

void append_little_endian(std::string& out, std::uint64_t number, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(number >> 8 * i & 0xff);
}

const json& members(const json& scene, const char* name) {
  static const json kNone = json::object();
  return scene.is_null() ? kNone : scene.at(name);
}

}  // namespace

std::string server_info(const std::string& session) {
  return json{{"op", "serverInfo"},
              {"name", "anchord"},
              {"capabilities", json::array()},
              {"supportedEncodings", json::array()},
              {"metadata", json::object()},
              {"sessionId", session}}
      .dump();
}

std::string advertise(const std::vector<Channel>& channels) {
  json list = json::array();
  for (const Channel& channel : channels)
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", "json"},
                    {"schemaName", channel.schema_name},
                    {"schemaEncoding", "jsonschema"},
                    {"schema", schema_of(channel.schema_name).dump()}});
  return json{{"op", "advertise"}, {"channels", std::move(list)}}.dump();
}

std::string message_data(std::uint32_t subscription, Utime utime, const json& message) {
  std::string out(1, kMessageData);
  append_little_endian(out, subscription, 4);
  append_little_endian(out, static_cast<std::uint64_t>(utime) * 1000, 8);
  return out + message.dump();
}

json scene_update(const json& before, const json& now, const std::string& frame) {
  const json &old = members(before, "objects"), &objects = now.at("objects");
  const Utime utime = now.at("utime");
  json deletions = json::array(), entities = json::array();
  for (const auto& [id, object] : old.items())
    if (!objects.contains(id))
      deletions.push_back({{"timestamp", time_of(utime)}, {"type", 0}, {"id", id}});
  for (const auto& [id, object] : objects.items()) {
    const auto was = old.find(id);
    if (was == old.end() || *was != object) entities.push_back(entity_of(id, object, utime, frame));
  }
  return {{"deletions", std::move(deletions)}, {"entities", std::move(entities)}};
}

json pose_in_frame(const json& scene, const std::string& robot, const std::string& frame) {
  const json& pose = scene.at("robots").at(robot);
  const json& q = pose.at("orientation");
  return {{"timestamp", time_of(scene.at("utime"))},
          {"frame_id", frame},
          {"pose",
           {{"position", point_of(pose.at("position"))},
            {"orientation", {{"x", q[1]}, {"y", q[2]}, {"z", q[3]}, {"w", q[0]}}}}}};
}

std::vector<json> log_lines(const json& before, const json& now) {
  std::vector<json> lines;
  if (before.is_null()) return lines;  // all that there is has not just come
  const Utime utime = now.at("utime");
  const auto say = [&](const std::string& message) { lines.push_back(log_line(utime, message)); };
  const json &old = members(before, "objects"), &objects = now.at("objects");
  for (const auto& [id, object] : objects.items())
    if (!old.contains(id))
      say(id + " is there" +
          (object.contains("place") ? ", " + object["place"].get<std::string>() : ""));
  for (const auto& [id, object] : old.items())
    if (!objects.contains(id)) say(id + " is there no more");
  const json &were = members(before, "tasks"), &tasks = now.at("tasks");
  for (const auto& [id, task] : tasks.items())
    if (!were.contains(id) || were[id]["state"] != task["state"])
      say("task " + id + " is " + task["state"].get<std::string>() + ": look at " +
          task["object"].get<std::string>());
  for (const auto& [id, task] : were.items())
    if (!tasks.contains(id)) say("task " + id + " has ended");
  return lines;
}

}  // namespace anchord::foxglove
