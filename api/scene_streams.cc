#include "api/scene_streams.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <utility>

#include "api/foxglove_client.h"

namespace anchord {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

constexpr double kLeastRate = 0.1, kRate = 10, kMostRate = 50;  // messages/s

Error no_rate() { return invalid("rate", "must be a number of messages per second, 0.1 to 50"); }

Result<milliseconds> pause_of(double rate) {
  if (!(rate >= kLeastRate && rate <= kMostRate)) return no_rate();
  return milliseconds(static_cast<std::int64_t>(1000 / rate));
}

Result<milliseconds> read_pause(const HttpTarget& target) {
  double rate = kRate;
  for (const auto& [name, value] : target.parameters) {
    if (name != "rate") return invalid(name, "is no parameter of the stream; it has: rate");
    const char* end = value.data() + value.size();
    const auto [rest, error] = std::from_chars(value.data(), end, rate);
    if (error != std::errc() || rest != end) return no_rate();
  }
  return pause_of(rate);
}

/// One who watches: the whole scene first, then what has changed since the last message.
class Watcher : public StreamClient {
 public:
  Watcher(SceneSource& scenes, milliseconds pause) : scenes_(scenes), pause_(pause) {}

  std::optional<Message> next() override {
    auto now = scenes_.current();
    if (told_ && told_->number == now->number) return std::nullopt;
    const std::string change = told_ ? scenes_.change(told_, now) : "";
    const bool whole = !told_ || change.size() >= now->text.size();
    const bool same = told_ && change.empty();
    told_ = std::move(now);
    if (same) return std::nullopt;
    const std::string begin = "{\"seq\":" + std::to_string(++sequence_);
    return Message{std::make_shared<std::string>(begin + (whole ? ",\"world\":" : ",\"change\":") +
                                                 (whole ? told_->text : change) + "}")};
  }

  milliseconds pause() const override { return pause_; }

  Status hear(std::string_view text) override {
    const json said = json::parse(text, nullptr, false);
    if (!said.is_object()) return invalid("", "must be a JSON object, such as {\"rate\": 5}");
    if (const auto rate = said.find("rate"); rate != said.end()) {
      const auto pause = rate->is_number() ? pause_of(rate->get<double>()) : no_rate();
      if (!pause) return pause.error();
      pause_ = *pause;
    }
    return Done{};
  }

 private:
  SceneSource& scenes_;
  milliseconds pause_;
  std::shared_ptr<const SceneSource::State> told_;
  std::uint64_t sequence_ = 0;
};

}  // namespace

StreamOpener scene_streams(SceneSource& scenes, std::string frame, const std::atomic<bool>& ready) {
  const auto began = std::chrono::system_clock::now().time_since_epoch().count();
  return [&scenes, session = std::to_string(began), frame = std::move(frame), &ready](
             const HttpTarget& target,
             const std::vector<std::string>& protocols) -> Result<StreamOpening> {
    const auto foxglove = std::find_first_of(protocols.begin(), protocols.end(),
                                             kFoxgloveProtocols.begin(), kFoxgloveProtocols.end());
    const bool of_foxglove = foxglove != protocols.end();
    if (target.path != "/v1/stream" && !(of_foxglove && target.path == "/"))
      return Error{ErrorCode::kUnknown, "", "there is no stream at " + target.path};
    if (!ready)
      return Error{ErrorCode::kUnavailable, "",
                   "the daemon is restoring its belief from the log, or ending; try again"};
    const auto pause = read_pause(target);
    if (!pause) return pause.error();
    if (of_foxglove)
      return StreamOpening{make_foxglove_client(scenes, session, frame, *pause), *foxglove};
    const bool named =
        std::find(protocols.begin(), protocols.end(), kStreamProtocol) != protocols.end();
    return StreamOpening{std::make_unique<Watcher>(scenes, *pause), named ? kStreamProtocol : ""};
  };
}

}  // namespace anchord
