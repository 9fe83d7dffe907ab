#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "knowledge/configuration.h"
#include "perception/detector_settings.h"

namespace anchord {

/// Reads a camera's file: JSON with comments and `include`, as a configuration (see
/// knowledge/configuration.h). `camera` must be there whole, and `view` and `colors`; what else is
/// left out keeps the defaults of DetectorSettings. Unknown keys are mistakes.
///
/// Without both `rotation` and `translation` the camera is carried: where it is comes with each
/// picture. `view` and `occluders`, pixels of a camera that stands still, are then mistakes.
///
///     {"sensor": "camera",
///      "camera": {"image": [768, 576], "focal": mm, "kappa1": 1/mm^2, "center": [u, v], "sx": 1,
///                 "pixel": [mm, mm], "rotation": [rx, ry, rz], "translation": [m, m, m]},
///      "view": [[u, v], ...], "occluders": [[[u, v], ...], ...],
///      "background": {"darkest", "brightest", "threshold", "width", "rate"},
///      "people": {"height", "height_deviation", "false_foreground", "least_gain",
///                 "least_foot_row"},
///      "noise": {"u": {"base", "covered", "weak"}, "v": {...}, "foot_offset": [u, v]},
///      "score": {"bias", "gain", "filled", "observed", "alone", "likeness"},
///      "colors": [{"name": "red", "hue": [330, 15], "saturation": [0.4, 1], "value": [0.2, 1]}],
///      "color_report": {"doubt", "sharpness", "least_pixels"},
///      "verification": {"appearances": {"cat": {"color": ["black"], "extent": [l, w, h]}},
///                       "least_visible", "least_body", "least_score", "least_confidence",
///                       "size_deviation", "pixel_noise", "edge_noise", "depth_noise", "looks"}}
///
/// Nothing, and at least one mistake, where the file is wrong.
std::optional<DetectorSettings> read_camera_file(const std::filesystem::path& file,
                                                 ConfigurationMistakes& mistakes);

/// The same from memory; includes are relative to `directory` and mistakes if that is empty.
std::optional<DetectorSettings> parse_camera_file(std::string_view text,
                                                  const std::filesystem::path& directory,
                                                  ConfigurationMistakes& mistakes);

}  // namespace anchord
