#pragma once

namespace anchord {

/// The LCM channels, each with the type it carries.
inline constexpr char kDetectionsChannel[] = "ANCHORD_DETECTIONS";  ///< frame_t, in
inline constexpr char kWorldChannel[] = "ANCHORD_WORLD";            ///< world_t, out
inline constexpr char kRejectedChannel[] = "ANCHORD_REJECTED";      ///< rejected_t, out
inline constexpr char kQueryChannel[] = "ANCHORD_QUERY";            ///< query_t, in
inline constexpr char kAnswerChannel[] = "ANCHORD_ANSWER";          ///< answer_t, out

}  // namespace anchord
