#include "daemon/lcm_front.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <utility>

#include "api/replies.h"
#include "api/world_message.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/checked_decode.h"

namespace anchord {
namespace {

constexpr std::size_t kWorldsWaiting = 256, kRefusalsWaiting = 256, kQuestionsWaiting = 64,
                      kTriggersWaiting = 64, kTasksWaiting = 4096;

Utime now() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

LcmFront::LcmFront(std::unique_ptr<LcmBus> bus, Statistics& statistics)
    : bus_(std::move(bus)),
      statistics_(statistics),
      publisher_(kWorldsWaiting),
      refusals_(kRefusalsWaiting),
      questions_(kQuestionsWaiting),
      triggers_(kTriggersWaiting),
      tasks_(kTasksWaiting) {}

Status LcmFront::start(Journal& journal, Verifications& verifications, Robots& robots,
                       Answerer answerer) {
  const std::pair<const char*, LcmBus::Handler> handlers[] = {
      {kDetectionsChannel, [this, &journal](auto bytes) { receive_frame(bytes, journal); }},
      {kEventChannel,
       [this, &journal, &robots](auto bytes) { receive_event(bytes, journal, robots); }},
      {kTriggerChannel,
       [this, &verifications](auto bytes) { receive_trigger(bytes, verifications); }},
      {kResultChannel,
       [this, &verifications](auto bytes) { receive_result(bytes, verifications); }},
      {kPoseChannel, [this, &verifications](auto bytes) { receive_pose(bytes, verifications); }},
      {kQueryChannel,
       [this, ask = std::move(answerer)](auto bytes) { receive_query(bytes, ask); }}};
  for (const auto& [channel, handler] : handlers)
    if (Status s = bus_->subscribe(channel, handler); !s) return s;
  bus_->start();
  return Done{};
}

void LcmFront::stop() {
  bus_->stop();
  questions_.stop();
  triggers_.stop();
}

void LcmFront::receive_frame(std::span<const std::uint8_t> bytes, Journal& journal) {
  ++statistics_.received_lcm;
  auto message = decode_frame(bytes);
  if (!message) {
    ++statistics_.refused;
    ++statistics_.refused_lcm;
    publish_refusal(kDetectionsChannel, nullptr, message.error());
    return;
  }
  statistics_.lost += gaps_.missing(message->frame.robot, message->frame.sensor, message->seq);
  Frame name;  // what tells of the frame once it has been handed on
  name.utime = message->frame.utime;
  name.sensor = message->frame.sensor;
  if (journal.submit({{std::move(message->frame)}, kDetectionsChannel, false, {}})) return;
  ++statistics_.overrun;
  publish_refusal(kDetectionsChannel, &name,
                  {ErrorCode::kUnavailable, "", "too many frames wait to be applied"});
}

void LcmFront::receive_query(std::span<const std::uint8_t> bytes, const Answerer& answerer) {
  auto query = decode_query(bytes);
  if (!query) {
    ++statistics_.refused_lcm;
    publish_refusal(kQueryChannel, nullptr, query.error());
    return;
  }
  const auto reply = [this](std::int64_t id, const HttpResponse& response) {
    send(kAnswerChannel, encode_answer(id, response));
  };
  const std::int64_t id = query->id;
  const bool taken = questions_.post([this, reply, answerer, asked = std::move(*query)] {
    ++statistics_.queries;
    const auto target = parse_target(asked.target);
    reply(asked.id, target ? answerer(*target) : http_error(target.error()));
  });
  if (!taken) reply(id, http_error(503, "unavailable", "too many questions wait"));
}

void LcmFront::publish_world(std::shared_ptr<const Belief> belief,
                             std::shared_ptr<const Background> background) {
  const std::int64_t number = ++worlds_;
  publisher_.post([this, number, belief = std::move(belief), background = std::move(background)] {
    send(kWorldChannel, encode_world(*belief, *background, number));
  });
}

void LcmFront::publish_refusal(const std::string& origin, const Frame* frame, const Error& why) {
  refusals_.post(
      [this, bytes = encode_refusal(origin, frame, why, now())] { send(kRejectedChannel, bytes); });
}

void LcmFront::send(const char* channel, const std::vector<std::uint8_t>& bytes) {
  if (Status sent = bus_->publish(channel, bytes); !sent)
    spdlog::warn("{} could not be published: {}", channel, sent.error().text());
  else
    ++statistics_.published_lcm;
}

}  // namespace anchord
