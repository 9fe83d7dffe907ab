#pragma once

namespace anchord {

/// The LCM channels, each with the type it carries.
inline constexpr char kDetectionsChannel[] = "ANCHORD_DETECTIONS";   ///< frame_t, in
inline constexpr char kWorldChannel[] = "ANCHORD_WORLD";             ///< world_t, out
inline constexpr char kRejectedChannel[] = "ANCHORD_REJECTED";       ///< rejected_t, out
inline constexpr char kQueryChannel[] = "ANCHORD_QUERY";             ///< query_t, in
inline constexpr char kAnswerChannel[] = "ANCHORD_ANSWER";           ///< answer_t, out
inline constexpr char kPoseChannel[] = "ANCHORD_POSE";               ///< robot_pose_t, in
inline constexpr char kEventChannel[] = "ANCHORD_EVENT";             ///< event_t, in
inline constexpr char kTriggerChannel[] = "ANCHORD_VERIFY_TRIGGER";  ///< verify_trigger_t, in
inline constexpr char kTaskChannel[] = "ANCHORD_VERIFY_TASK";        ///< verify_task_t, out
inline constexpr char kResultChannel[] = "ANCHORD_VERIFY_RESULT";    ///< verify_result_t, in
inline constexpr char kImageChannel[] = "ANCHORD_IMAGE";  ///< image_t, between cameras and
                                                          ///< verification modules
/// In exported logs only: notes as JSON text (api/replay_note.h), no LCM type.
inline constexpr char kReplayChannel[] = "ANCHORD_REPLAY";

}  // namespace anchord
