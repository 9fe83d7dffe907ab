#include "api/foxglove_client.h"

#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "api/foxglove.h"

namespace anchord {
namespace {

using nlohmann::json;
using State = SceneSource::State;

constexpr std::size_t kMostSubscriptions = 64;
constexpr std::size_t kMostLines = 64;  // of one change; whoever is slow is told of these at once

class FoxgloveClient : public StreamClient {
 public:
  FoxgloveClient(SceneSource& scenes, const std::string& session, std::string frame,
                 std::chrono::milliseconds pause)
      : scenes_(scenes), frame_(std::move(frame)), pause_(pause) {
    tell(foxglove::server_info(session));
    tell(foxglove::advertise({{foxglove::kScene, "/anchord/scene", "foxglove.SceneUpdate"},
                              {foxglove::kLog, "/anchord/log", "foxglove.Log"}}));
  }

  std::optional<Message> next() override {
    if (waiting_.empty()) look();
    if (waiting_.empty()) return std::nullopt;
    Message message = std::move(waiting_.front());
    waiting_.pop_front();
    return message;
  }

  /// What has been made of one look is said at once.
  std::chrono::milliseconds pause() const override {
    return waiting_.empty() ? pause_ : std::chrono::milliseconds(0);
  }

  Status hear(std::string_view text) override {
    const json said = json::parse(text, nullptr, false);
    if (!said.is_object() || !said.contains("op") || !said["op"].is_string())
      return invalid("op", "must be there, as the protocol has it");
    if (said["op"] == "subscribe") return subscribe(said);
    if (said["op"] == "unsubscribe") return unsubscribe(said);
    return Done{};  // what no capability was announced for
  }

 private:
  struct Subscription {
    std::uint32_t channel;
    std::shared_ptr<const State> told;
  };

  static bool is_number(const json& value) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() <= 0xffff'ffff;
  }

  Status subscribe(const json& said) {
    const auto list = said.find("subscriptions");
    if (list == said.end() || !list->is_array())
      return invalid("subscriptions", "must be an array");
    for (const json& entry : *list) {
      if (!entry.is_object() || !entry.contains("id") || !entry.contains("channelId") ||
          !is_number(entry["id"]) || !is_number(entry["channelId"]))
        return invalid("subscriptions", "each has a number for id and channelId");
      if (subscriptions_.size() >= kMostSubscriptions)
        return invalid("subscriptions",
                       "there may be " + std::to_string(kMostSubscriptions) + " at a time");
      subscriptions_[entry["id"]] = {entry["channelId"], nullptr};
    }
    return Done{};
  }

  Status unsubscribe(const json& said) {
    const auto list = said.find("subscriptionIds");
    if (list == said.end() || !list->is_array())
      return invalid("subscriptionIds", "must be an array");
    for (const json& id : *list)
      if (is_number(id)) subscriptions_.erase(id.get<std::uint32_t>());
    return Done{};
  }

  /// Makes messages of what has changed since each subscription was last told.
  void look() {
    const auto now = scenes_.current();
    for (const auto& [robot, pose] : now->scene["robots"].items())
      if (!robots_.contains(robot) && robots_.size() < kMostSubscriptions) {
        const auto id = foxglove::kFirstRobot + static_cast<std::uint32_t>(robots_.size());
        robots_[robot] = id;
        tell(foxglove::advertise({{id, "/anchord/robots/" + robot, "foxglove.PoseInFrame"}}));
      }
    for (auto& [id, subscription] : subscriptions_) {
      if (subscription.told && subscription.told->number == now->number) continue;
      tell(id, subscription, *now);
      subscription.told = now;
    }
  }

  void tell(std::uint32_t id, const Subscription& subscription, const State& now) {
    const json before = subscription.told ? subscription.told->scene : json();
    const auto say = [&](const json& message) {
      waiting_.push_back({std::make_shared<std::string>(
                              foxglove::message_data(id, now.scene["utime"].get<Utime>(), message)),
                          true});
    };
    if (subscription.channel == foxglove::kScene) {
      const json update = foxglove::scene_update(before, now.scene, frame_);
      if (!update["entities"].empty() || !update["deletions"].empty() || before.is_null())
        say(update);
    } else if (subscription.channel == foxglove::kLog) {
      auto lines = foxglove::log_lines(before, now.scene);
      if (lines.size() > kMostLines) lines.resize(kMostLines);
      for (const json& line : lines) say(line);
    } else {
      for (const auto& [robot, channel] : robots_) {
        if (channel != subscription.channel || !now.scene["robots"].contains(robot)) continue;
        const bool same = !before.is_null() && before["robots"].contains(robot) &&
                          before["robots"][robot] == now.scene["robots"][robot];
        if (!same) say(foxglove::pose_in_frame(now.scene, robot, frame_));
      }
    }
  }

  void tell(std::string text) {
    waiting_.push_back({std::make_shared<std::string>(std::move(text)), false});
  }

  SceneSource& scenes_;
  const std::string frame_;
  const std::chrono::milliseconds pause_;
  std::deque<Message> waiting_;  ///< of one look
  std::map<std::uint32_t, Subscription> subscriptions_;
  std::map<std::string, std::uint32_t> robots_;  ///< their channels
};

}  // namespace

std::unique_ptr<StreamClient> make_foxglove_client(SceneSource& scenes, const std::string& session,
                                                   std::string frame,
                                                   std::chrono::milliseconds pause) {
  return std::make_unique<FoxgloveClient>(scenes, session, std::move(frame), pause);
}

}  // namespace anchord
