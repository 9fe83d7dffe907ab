#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "tools/anchorctl/fields.h"
#include "tools/anchorctl/table.h"

namespace anchord {

/// Frames per second, from the counter of accepted ones over the last few seconds.
class FrameRate {
 public:
  /// `now_s` on a clock that never goes back. A counter that is smaller than before begins anew.
  void add(double now_s, std::optional<double> accepted);
  /// Nothing before there are two readings.
  std::optional<double> per_second() const;

 private:
  std::deque<std::pair<double, double>> readings_;  // time, counter
};

/// "127.0.0.1:7780  22:13:20  29.8 frames/s  12 hypotheses in 3 clusters  2 refused".
std::string watch_status_line(const Json& status, const std::string& server,
                              std::optional<double> frames_per_second);

/// The table of objects, in the order in which they come; `style.height` lines at most. What was
/// last seen when is told as its age: the status line has the newest frame's time.
std::string watch_table(const Json& objects, const Style& style);

/// The escape sequences that put `text` in the place of all that the terminal shows, without
/// flicker. It ends below the text.
std::string redrawn(const std::string& text);

}  // namespace anchord
