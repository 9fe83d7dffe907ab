#include "lcmtypes/verification_codec.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <anchord/event_t.hpp>
#include <anchord/image_t.hpp>
#include <anchord/robot_pose_t.hpp>
#include <anchord/verify_result_t.hpp>
#include <anchord/verify_task_t.hpp>
#include <anchord/verify_trigger_t.hpp>
#include <limits>

#include "lcmtypes/codec.h"
#include "lcmtypes/event_codec.h"
#include "lcmtypes/image_codec.h"
#include "tests/lcmtypes/random_verification.h"
#include "tests/lcmtypes/sample_verification.h"

namespace anchord {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// What `decoder` makes of the bytes; the default, and a failure, if it refuses them.
template <typename Message>
Message decoded(Result<Message> (*decoder)(std::span<const std::uint8_t>), const Bytes& bytes) {
  Result<Message> message = decoder(bytes);
  EXPECT_TRUE(message.ok()) << message.error().text();
  return message ? *message : Message{};
}

Event event_of(const Bytes& bytes) { return decoded(decode_event, bytes).event; }

TEST(EventCodec, GivesBackRandomEvents) {
  EXPECT_TRUE(rc::check("decode undoes encode, and encode decode", [] {
    const Event event = testing::random_event();
    const std::int64_t seq = testing::random_integer();
    const Bytes bytes = encode(event, seq);
    const Result<EventMessage> message = decode_event(bytes);
    RC_ASSERT(message.ok());
    RC_ASSERT(message->event == event);
    RC_ASSERT(message->seq == seq);
    RC_ASSERT(encode(message->event, message->seq) == bytes);
    const Bytes stored = canonical_bytes(event);
    RC_ASSERT(canonical_bytes(event_of(stored)) == stored);
  }));
}

TEST(VerificationCodec, GivesBackRandomMessages) {
  EXPECT_TRUE(rc::check("triggers", [] {
    const TriggerMessage message = testing::random_trigger();
    RC_ASSERT(decoded(decode_trigger, encode(message)) == message);
  }));
  EXPECT_TRUE(rc::check("tasks", [] {
    const TaskMessage message{testing::random_integer(), testing::random_task()};
    RC_ASSERT(decoded(decode_task, encode(message)) == message);
    const Bytes stored = canonical_bytes(message.task);
    RC_ASSERT(canonical_bytes(decoded(decode_task, stored).task) == stored);
  }));
  EXPECT_TRUE(rc::check("results", [] {
    const VerificationResult result = testing::random_result();
    RC_ASSERT(decoded(decode_result, encode(result)) == result);
  }));
  EXPECT_TRUE(rc::check("poses", [] {
    const RobotPose pose = testing::random_robot_pose();
    RC_ASSERT(decoded(decode_pose, encode(pose)) == pose);
  }));
}

TEST(ImageCodec, GivesBackRandomImages) {
  EXPECT_TRUE(rc::check("images", [] {
    const ImageMessage image = testing::random_image();
    RC_ASSERT(decoded(decode_image, encode(image)) == image);
  }));
}

TEST(EventCodec, TheNumberIsNoContent) {
  const Event event = testing::full_event();
  EXPECT_NE(encode(event, 1), encode(event, 2));
  EXPECT_EQ(canonical_bytes(event_of(encode(event, 1))), canonical_bytes(event));
}

TEST(VerificationCodec, TheTimeOfPublicationIsNoContentOfATask) {
  const TaskMessage message = testing::full_task();
  EXPECT_EQ(canonical_bytes(decoded(decode_task, encode(message)).task),
            canonical_bytes(message.task));
}

TEST(EventCodec, KeepsNumbersThatAreNone) {
  Event event = testing::full_event();
  event.position->front() = kNan;
  event.regions[0].radius = -std::numeric_limits<double>::infinity();
  const Bytes bytes = canonical_bytes(event);
  EXPECT_EQ(canonical_bytes(event_of(bytes)), bytes);
}

/// The constants in the .lcm files are the enumerators in core.
TEST(VerificationCodec, WritesWhatLcmGenReads) {
  const auto read = [](auto message, const Bytes& bytes) {
    EXPECT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
              static_cast<int>(bytes.size()));
    return message;
  };
  using Kind = Event::Kind;
  const std::pair<Kind, int> kinds[] = {
      {Kind::kMissing, event_t::MISSING}, {Kind::kGrasped, event_t::GRASPED},
      {Kind::kCarried, event_t::CARRIED}, {Kind::kPlaced, event_t::PLACED},
      {Kind::kMoved, event_t::MOVED},     {Kind::kRemoved, event_t::REMOVED},
      {Kind::kNamed, event_t::NAMED},     {Kind::kJoined, event_t::JOINED},
      {Kind::kDropped, event_t::DROPPED}, {Kind::kUndone, event_t::UNDONE}};
  for (const auto& [kind, constant] : kinds) {
    Event event = testing::full_event();
    event.kind = kind;
    EXPECT_EQ(read(event_t(), encode(event, 1)).kind, constant);
  }
  using State = Task::State;
  const std::pair<State, int> states[] = {
      {State::kQueued, verify_task_t::QUEUED},      {State::kIssued, verify_task_t::ISSUED},
      {State::kFound, verify_task_t::FOUND},        {State::kMissing, verify_task_t::MISSING},
      {State::kOccluded, verify_task_t::OCCLUDED},  {State::kExpired, verify_task_t::EXPIRED},
      {State::kCancelled, verify_task_t::CANCELLED}};
  for (const auto& [state, constant] : states) {
    TaskMessage task = testing::full_task();
    task.task.state = state;
    EXPECT_EQ(read(verify_task_t(), encode(task)).state, constant);
  }
  using Outcome = VerificationResult::Outcome;
  const std::pair<Outcome, int> outcomes[] = {{Outcome::kFound, verify_result_t::FOUND},
                                              {Outcome::kMissing, verify_result_t::MISSING},
                                              {Outcome::kOccluded, verify_result_t::OCCLUDED}};
  for (const auto& [outcome, constant] : outcomes) {
    VerificationResult result = testing::full_result();
    result.outcome = outcome;
    EXPECT_EQ(read(verify_result_t(), encode(result)).outcome, constant);
  }
  using Format = ImageMessage::Format;
  const std::pair<Format, int> formats[] = {{Format::kGray8, image_t::GRAY8},
                                            {Format::kBgr8, image_t::BGR8},
                                            {Format::kJpeg, image_t::JPEG},
                                            {Format::kDepth16Mm, image_t::DEPTH16_MM}};
  for (const auto& [format, constant] : formats) {
    ImageMessage image = testing::full_image();
    image.format = format;
    EXPECT_EQ(read(image_t(), encode(image)).format, constant);
  }
  const verify_trigger_t cancel = read(verify_trigger_t(), encode(testing::cancelling()));
  EXPECT_EQ(cancel.command, verify_trigger_t::CANCEL);
  EXPECT_EQ(cancel.task, 3);
  const event_t event = read(event_t(), encode(testing::full_event(), 1));
  ASSERT_EQ(event.num_regions, 2);
  EXPECT_EQ(event.regions[0].kind, region_t::ELLIPSOID);
  EXPECT_EQ(event.regions[1].kind, region_t::PRISM);
  EXPECT_EQ(read(robot_pose_t(), encode(testing::full_pose())).robot, "amigo");
}

/// Publishers leave what they do not use as it comes: a C++ program even uninitialised.
TEST(EventCodec, UnusedNumbersDoNotMatter) {
  event_t message{};
  message.regions.resize(2);
  message.num_regions = 2;
  message.regions[1].kind = region_t::PRISM;
  const Event plain = event_of(encode_message(message));
  message.position[1] = message.covariance[3] = kNan;
  message.regions[0].z[0] = kNan;
  message.regions[1].center[2] = message.regions[1].covariance[0] = kNan;
  message.regions[1].radius = kNan;
  EXPECT_EQ(event_of(encode_message(message)), plain);
}

TEST(VerificationCodec, UnusedNumbersDoNotMatter) {
  verify_task_t task{};
  task.viewpoint.position[0] = kNan;
  EXPECT_EQ(decoded(decode_task, encode_message(task)), TaskMessage{});
  image_t image{};
  image.sensor = "s";
  image.width = image.height = image.num_bytes = 1;
  image.data = {9};
  const ImageMessage plain = decoded(decode_image, encode_message(image));
  image.pose.orientation[2] = kNan;
  EXPECT_EQ(decoded(decode_image, encode_message(image)), plain);
}

TEST(VerificationCodec, ACancellingHasNoTriggerAndATriggerNoTask) {
  verify_trigger_t message{};
  message.task = 5;
  message.object = "cup-1";
  message.tag = 4;
  message.timeout_s = kNan;
  message.command = verify_trigger_t::CANCEL;
  EXPECT_EQ(decoded(decode_trigger, encode_message(message)), (TriggerMessage{0, true, 5, {}}));
  message.command = verify_trigger_t::TRIGGER;
  message.timeout_s = 0;
  Trigger trigger;
  trigger.object = "cup-1";
  trigger.tag = 4;
  EXPECT_EQ(decoded(decode_trigger, encode_message(message)),
            (TriggerMessage{0, false, 0, trigger}));
}

/// A planner that has nothing to report leaves the frame as lcm-gen makes it: without a sensor.
TEST(VerificationCodec, AFrameThatIsNotUsedNeedsNothing) {
  verify_result_t message{};
  message.outcome = verify_result_t::OCCLUDED;
  message.frame.pose.position[0] = kNan;
  const auto result = decoded(decode_result, encode_message(message));
  EXPECT_EQ(result.outcome, VerificationResult::Outcome::kOccluded);
  EXPECT_FALSE(result.frame.has_value());
}

TEST(EventCodecDeathTest, AbortsOnAMalformedEvent) {
  Event event = testing::full_event();
  event.place = std::string("a\0b", 3);
  EXPECT_DEATH((void)encode(event, 1), "NUL");
}

}  // namespace
}  // namespace anchord
