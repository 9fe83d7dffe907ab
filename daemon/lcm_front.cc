#include "daemon/lcm_front.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <string_view>
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

LcmFront::LcmFront(std::unique_ptr<LcmSender> sender, std::unique_ptr<LcmReceiver> receiver,
                   Statistics& statistics)
    : sender_(std::move(sender)),
      receiver_(std::move(receiver)),
      statistics_(statistics),
      publisher_(kWorldsWaiting),
      refusals_(kRefusalsWaiting),
      questions_(kQuestionsWaiting),
      triggers_(kTriggersWaiting),
      tasks_(kTasksWaiting) {}

void LcmFront::start(Journal& journal, Verifications& verifications, Robots& robots,
                     Answerer answerer) {
  receiver_->start([this, &journal, &verifications, &robots,
                    ask = std::move(answerer)](const LcmRecord& record) {
    const std::string_view channel = kReceivedChannels[record.channel];
    const auto bytes = record.bytes;
    if (record.kind == LcmRecord::Kind::kRefused)
      receive_refusal(channel.data(), refusal(bytes));
    else if (channel == kDetectionsChannel)
      receive_frame(bytes, journal);
    else if (channel == kEventChannel)
      receive_event(bytes, journal, robots);
    else if (channel == kTriggerChannel)
      receive_trigger(bytes, verifications);
    else if (channel == kResultChannel)
      receive_result(bytes, verifications);
    else if (channel == kPoseChannel)
      receive_pose(bytes, verifications);
    else
      receive_query(bytes, ask);
  });
}

void LcmFront::stop() {
  receiver_->stop();
  questions_.stop();
  triggers_.stop();
}

/// What the receiving process did not pass on.
void LcmFront::receive_refusal(const char* channel, const Error& why) {
  if (std::string_view(channel) == kDetectionsChannel) {
    ++statistics_.received_lcm;
    ++statistics_.refused;
  }
  refuse(channel, why);
}

void LcmFront::receive_frame(std::span<const std::uint8_t> bytes, Journal& journal) {
  auto message = decode_frame(bytes);
  if (!message) return receive_refusal(kDetectionsChannel, message.error());
  ++statistics_.received_lcm;
  statistics_.lost += gaps_.missing(message->frame.robot, message->frame.sensor, message->seq);
  Frame name;  // what tells of the frame once it has been handed on
  name.utime = message->frame.utime;
  name.sensor = message->frame.sensor;
  Submission submission{{std::move(message->frame)}, kDetectionsChannel, false, {}};
  submission.bytes = bytes.size();
  if (journal.submit(std::move(submission))) return;
  ++statistics_.overrun;
  publish_refusal(kDetectionsChannel, &name,
                  {ErrorCode::kUnavailable, "", "too many frames wait to be applied"});
}

void LcmFront::receive_query(std::span<const std::uint8_t> bytes, const Answerer& answerer) {
  auto query = decode_query(bytes);
  if (!query) return refuse(kQueryChannel, query.error());
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
  if (Status sent = sender_->publish(channel, bytes); !sent)
    spdlog::warn("{} could not be published: {}", channel, sent.error().text());
  else
    ++statistics_.published_lcm;
}

}  // namespace anchord
