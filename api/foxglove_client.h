#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <string>

#include "api/scene_source.h"
#include "api/stream.h"

namespace anchord {

/// The subprotocols of Foxglove's WebSocket protocol that are spoken, alike in what is used here.
inline constexpr std::array<const char*, 2> kFoxgloveProtocols{"foxglove.sdk.v1",
                                                               "foxglove.websocket.v1"};

/// One who watches with Foxglove's tools: `/anchord/scene` (foxglove.SceneUpdate), `/anchord/log`
/// (foxglove.Log), and `/anchord/robots/NAME` (foxglove.PoseInFrame), in JSON; see docs/stream.md.
/// `session` is another one after each start of the daemon: by that they forget what was before.
/// `frame`: the map's. `pause`: between what is made of two looks at the scene.
std::unique_ptr<StreamClient> make_foxglove_client(SceneSource& scenes, const std::string& session,
                                                   std::string frame,
                                                   std::chrono::milliseconds pause);

}  // namespace anchord
