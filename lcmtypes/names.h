#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace anchord {

/// What a message may hold, whichever way it comes in; more is refused before it is read. The
/// limit on detections is kMaxDetections in core/frame.h, those on regions and tags are kMaxRegions
/// in core/event.h and kMaxTags in core/verification.h.
inline constexpr std::size_t kMaxMessageBytes = 8u << 20;
inline constexpr std::size_t kMaxNameBytes = 256;
inline constexpr std::size_t kMaxTargetBytes = 8192;  ///< of a query
inline constexpr std::size_t kMaxAttributes = 256;    ///< of a detection
inline constexpr std::size_t kMaxSymbols = 256;       ///< of an attribute
inline constexpr std::size_t kMaxPolygonPoints = 1000;
inline constexpr std::size_t kMaxReasonBytes = 1024;  ///< of a task
/// An image's message may be larger than the others: 3840 * 2160 pixels of 3 bytes are 24 MiB.
inline constexpr std::size_t kMaxImageMessageBytes = 32u << 20;
inline constexpr std::size_t kMaxImageSide = 16384;  ///< pixels

/// Why `text` is refused, as the end of a sentence ("must be UTF-8"), or nullptr if it is fine: at
/// most `max_bytes`, valid UTF-8, no control characters (they would reach logs, terminals and
/// JSON).
const char* text_fault(std::string_view text, std::size_t max_bytes = kMaxNameBytes);

/// As text_fault(), and a name must not be empty.
const char* name_fault(std::string_view text);

/// Index of the first name that stands earlier in `names` too, or -1.
int first_repeated(const std::vector<std::string_view>& names);

}  // namespace anchord
