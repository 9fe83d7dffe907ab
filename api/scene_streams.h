#pragma once

#include <atomic>

#include "api/scene_source.h"
#include "api/stream.h"

namespace anchord {

/// The subprotocol of GET /v1/stream; see docs/stream.md.
inline constexpr char kStreamProtocol[] = "anchord.v1";

/// Lets in who asks for `/v1/stream?rate=HZ`, once the daemon is ready; Foxglove's tools at `/`,
/// too, since they cannot be given a path. `frame`: the map's. Errors: kUnknown: another path;
/// kInvalid: a parameter that cannot be; kUnavailable.
StreamOpener scene_streams(SceneSource& scenes, std::string frame, const std::atomic<bool>& ready);

}  // namespace anchord
