#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/frame.h"

namespace anchord::foxglove {

/// The scene of the stream (scene_json()) in Foxglove's terms, so that its tools show the world
/// with nothing of ours installed: https://github.com/foxglove/ws-protocol, docs/spec.md, and
/// https://github.com/foxglove/foxglove-sdk, schemas. All in the frame of the map.

/// What is known of a channel before anything is said on it.
struct Channel {
  std::uint32_t id;
  std::string topic, schema_name;
};
inline constexpr std::uint32_t kScene = 1, kLog = 2, kFirstRobot = 16;

/// `serverInfo`, the first message on a connection.
std::string server_info(const std::string& session);
/// `advertise`: channels with their schemas, in JSON.
std::string advertise(const std::vector<Channel>& channels);

/// A message on a subscription: opcode, subscription, time, JSON.
std::string message_data(std::uint32_t subscription, Utime utime, const nlohmann::json& message);

/// foxglove.SceneUpdate: an entity, shape and name, for each object that is not as it was, and the
/// deletion of what is no more. Nothing of both: nothing has changed. `before` is null at first.
nlohmann::json scene_update(const nlohmann::json& before, const nlohmann::json& now,
                            const std::string& frame);
/// foxglove.PoseInFrame of a robot in a scene.
nlohmann::json pose_in_frame(const nlohmann::json& scene, const std::string& robot,
                             const std::string& frame);
/// foxglove.Log, one for each object that has come or gone, and each task that has changed.
std::vector<nlohmann::json> log_lines(const nlohmann::json& before, const nlohmann::json& now);

}  // namespace anchord::foxglove
