#include "tools/anchorctl/watch_text.h"

#include <algorithm>
#include <cmath>

#include "tools/anchorctl/format.h"

namespace anchord {
namespace {

constexpr double kRateWindow_s = 5;

std::string speed(const Json& object) {
  const auto velocity = numbers(object, "velocity");
  if (velocity.empty()) return "-";
  double square = 0;
  for (const double axis : velocity) square += axis * axis;
  return decimal(std::sqrt(square)) + " m/s";
}

std::string age(std::optional<Utime> seen, std::optional<Utime> newest) {
  return seen && newest ? duration(seconds_between(*seen, *newest)) : "-";
}

std::string count_of(const Json& status, const char* name) {
  const auto count = number(status, name);
  return count ? decimal(*count, 0) : "-";
}

}  // namespace

void FrameRate::add(double now_s, std::optional<double> accepted) {
  if (!accepted || (!readings_.empty() && *accepted < readings_.back().second)) readings_.clear();
  if (accepted) readings_.emplace_back(now_s, *accepted);
  while (readings_.size() > 2 && now_s - readings_[1].first >= kRateWindow_s) {
    readings_.pop_front();
  }
}

std::optional<double> FrameRate::per_second() const {
  if (readings_.size() < 2) return std::nullopt;
  const double span_s = readings_.back().first - readings_.front().first;
  if (span_s <= 0) return std::nullopt;
  return (readings_.back().second - readings_.front().second) / span_s;
}

std::string watch_status_line(const Json& status, const std::string& server,
                              std::optional<double> frames_per_second) {
  const Json& frames = items(status, "frames");
  return server + "  " + time_of_day(utime(status, "utime")) + "  " +
         (frames_per_second ? decimal(*frames_per_second, 1) : "-") + " frames/s  " +
         count_of(status, "hypotheses") + " hypotheses in " + count_of(status, "clusters") +
         " clusters  " + count_of(frames, "refused") + " refused";
}

std::string watch_table(const Json& answer, const Style& style) {
  const auto newest = utime(answer, "utime");
  const Json& objects = items(answer, "objects");
  const bool moving = std::any_of(objects.begin(), objects.end(),
                                  [](const Json& object) { return member(object, "velocity"); });
  std::vector<Table::Column> columns{{"OBJECT"}, {"P"}, {"CLASS"}, {"PLACE"}, {"POSITION [m]"}};
  if (moving) columns.push_back({"SPEED"});
  columns.push_back({"SEEN AGO"});
  Table table(std::move(columns));
  std::size_t rows = objects.size();
  const auto room = static_cast<std::size_t>(std::max(style.height - 2, 1));  // header, "and more"
  if (style.height > 0 && rows + 1 > static_cast<std::size_t>(style.height)) rows = room;
  std::size_t row = 0;
  for (const Json& object : objects) {
    if (row++ == rows) break;
    const auto p = number(object, "p");
    std::vector<std::string> cells{
        text(object, "id"), probability(p), class_of(object), text(object, "place"),
        position(numbers(object, "position"), numbers(object, "covariance"))};
    if (moving) cells.push_back(speed(object));
    cells.push_back(age(utime(object, "last_seen"), newest));
    table.add(std::move(cells), p.value_or(1) < 0.5);
  }
  if (table.empty()) return "no object\n";
  const std::size_t hidden = objects.size() - std::min(rows, objects.size());
  return table.text(style) + (hidden ? "and " + std::to_string(hidden) + " more\n" : "");
}

std::string redrawn(const std::string& text) {
  std::string screen = "\x1b[H";
  for (const char c : text) screen += c == '\n' ? std::string("\x1b[K\n") : std::string(1, c);
  return screen + "\x1b[J";
}

}  // namespace anchord
