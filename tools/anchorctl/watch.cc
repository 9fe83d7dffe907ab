#include "tools/anchorctl/watch.h"

#include <algorithm>

#include "tools/anchorctl/changes.h"
#include "tools/anchorctl/watch_text.h"

namespace anchord {
namespace {

/// What has been shown so far.
class Watch {
 public:
  Watch(const WatchSettings& settings, const WatchSeams& seams)
      : settings_(settings), seams_(seams) {}

  /// Asks once and shows what is new.
  Status look() {
    auto objects = seams_.fetch(settings_.objects_target);
    if (!objects) return without(objects.error());
    if (settings_.output == WatchSettings::Output::kScreen) return draw(*std::move(objects));
    back();
    std::string lines;
    if (settings_.output == WatchSettings::Output::kJson) {
      if (objects->text != last_text_) lines = objects->text;
      if (!lines.empty() && lines.back() != '\n') lines += '\n';
      last_text_ = std::move(objects->text);
    } else {
      for (const auto& line : changes_.update(objects->json)) lines += line + "\n";
    }
    return print(lines);
  }

  /// An error if the daemon has never answered.
  Status ended() const {
    if (answered_ || !refusal_) return Done{};
    return *refusal_;
  }

 private:
  void back() {
    if (refusal_) seams_.note("the daemon at " + settings_.server + " answers");
    refusal_.reset();
    answered_ = true;
  }

  Status draw(Answer objects) {
    auto status = seams_.fetch("/v1/status");
    if (!status) return without(status.error());
    refusal_.reset();
    answered_ = true;
    rate_.add(seams_.now_s(), number(items(status->json, "frames"), "accepted"));
    last_objects_ = std::move(objects.json);
    return screen(watch_status_line(status->json, settings_.server, rate_.per_second()));
  }

  Status screen(const std::string& first_line) {
    Style style = seams_.style();
    std::string shown = bold(cut(first_line, style.width), style) + "\n\n";
    style.height = std::max(style.height - 3, 0);  // the two lines above, the cursor's below
    if (!last_objects_.is_null()) shown += watch_table(last_objects_, style);
    return print(redrawn(shown));
  }

  Status without(const Error& error) {
    if (!seams_.wait(0)) return Done{};  // the question was given up
    if (error.code != ErrorCode::kUnavailable) return error;
    const bool first = !refusal_;
    refusal_ = error;
    rate_.add(seams_.now_s(), std::nullopt);
    const std::string waiting = "waiting for the daemon at " + settings_.server;
    if (settings_.output == WatchSettings::Output::kScreen) return screen(waiting);
    if (first) seams_.note(waiting + ": " + error.text());
    return Done{};
  }

  Status print(const std::string& text) {
    if (text.empty() || seams_.print(text)) return Done{};
    return Error{ErrorCode::kIo, "standard output", "cannot be written to"};
  }

  const WatchSettings& settings_;
  const WatchSeams& seams_;
  Changes changes_;
  FrameRate rate_;
  Json last_objects_;
  std::string last_text_;
  std::optional<Error> refusal_;  ///< since the daemon has been away
  bool answered_ = false;
};

}  // namespace

Status watch(const WatchSettings& settings, const WatchSeams& seams) {
  Watch watch(settings, seams);
  const double start_s = seams.now_s();
  for (;;) {
    if (auto looked = watch.look(); !looked) return looked;
    double wait_s = settings.interval_s;
    if (settings.for_s) {
      const double left_s = start_s + *settings.for_s - seams.now_s();
      if (left_s <= 0) return watch.ended();
      wait_s = std::min(wait_s, left_s);
    }
    if (!seams.wait(wait_s)) return Done{};
  }
}

}  // namespace anchord
