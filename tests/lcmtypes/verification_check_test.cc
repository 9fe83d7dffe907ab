#include <gtest/gtest.h>

#include <anchord/event_t.hpp>
#include <anchord/image_t.hpp>
#include <anchord/verify_result_t.hpp>
#include <anchord/verify_task_t.hpp>
#include <anchord/verify_trigger_t.hpp>
#include <functional>
#include <string>

#include "lcmtypes/codec.h"
#include "lcmtypes/event_codec.h"
#include "lcmtypes/image_codec.h"
#include "lcmtypes/names.h"
#include "lcmtypes/verification_codec.h"
#include "tests/lcmtypes/sample_verification.h"
#include "tests/lcmtypes/wire_bytes.h"

namespace anchord {
namespace {

using testing::Bytes;
using testing::field_of;
using testing::field_with;
using testing::overwrite;

std::string event_with(const std::function<void(event_t&)>& change) {
  return field_with<event_t>(decode_event, encode(testing::full_event(), 1), change);
}
std::string trigger_with(const std::function<void(verify_trigger_t&)>& change) {
  return field_with<verify_trigger_t>(decode_trigger, encode(testing::full_trigger()), change);
}
std::string task_with(const std::function<void(verify_task_t&)>& change) {
  return field_with<verify_task_t>(decode_task, encode(testing::full_task()), change);
}
std::string result_with(const std::function<void(verify_result_t&)>& change) {
  return field_with<verify_result_t>(decode_result, encode(testing::full_result()), change);
}
std::string image_with(const std::function<void(image_t&)>& change) {
  return field_with<image_t>(decode_image, encode(testing::full_image()), change);
}

TEST(VerificationCheckFields, NamesTheCountThatLies) {
  Event event;
  event.kind = Event::Kind::kMissing;
  event.regions = {testing::two_regions()[1]};
  event.regions[0].polygon.clear();
  const Bytes bytes = encode(event, 1);
  // From the end of the message: undone (8), and a prism without points is kind (1), p, center,
  // covariance, radius (14 * 8), num_points (4), z (16).
  const std::size_t region = bytes.size() - 8 - 133;
  for (const std::uint32_t lie : {3u, 0xffffu, 0x7fffffffu, 0x80000000u, ~0u}) {
    Bytes changed = bytes;
    overwrite(changed, region - 4, lie);
    EXPECT_EQ(field_of(decode_event, changed), "num_regions") << lie;
    changed = bytes;
    overwrite(changed, region + 1 + 14 * 8, lie);
    EXPECT_EQ(field_of(decode_event, changed), "regions[0].num_points") << lie;
  }
  TaskMessage task;
  task.task.tags = {};
  const Bytes task_bytes = encode(task);
  // After fingerprint, utime and id (24), state and triggered (2).
  for (const std::uint32_t lie : {0xffffu, 0x7fffffffu, 0x80000000u, ~0u}) {
    Bytes changed = task_bytes;
    overwrite(changed, 26, lie);
    EXPECT_EQ(field_of(decode_task, changed), "num_tags") << lie;
  }
  const ImageMessage image = testing::full_image();
  const Bytes image_bytes = encode(image);
  const std::size_t num_bytes = image_bytes.size() - image.data.size() - 4;
  for (const std::uint32_t lie : {17u, 19u, 0x7fffffffu, 0x80000000u, ~0u}) {
    Bytes changed = image_bytes;
    overwrite(changed, num_bytes, lie);
    EXPECT_EQ(field_of(decode_image, changed), "num_bytes") << lie;
  }
}

TEST(VerificationCheckFields, RefusesWhatIsNoConstant) {
  EXPECT_EQ(event_with([](event_t& e) { e.kind = 10; }), "kind");
  EXPECT_EQ(event_with([](event_t& e) { e.kind = -1; }), "kind");
  EXPECT_EQ(event_with([](event_t& e) { e.has_position = 2; }), "has_position");
  EXPECT_EQ(event_with([](event_t& e) { e.has_covariance = -1; }), "has_covariance");
  EXPECT_EQ(event_with([](event_t& e) { e.regions[1].kind = 2; }), "regions[1].kind");
  EXPECT_EQ(event_with([](event_t& e) { e.regions[1].kind = region_t::ELLIPSOID; }),
            "regions[1].num_points");
  EXPECT_EQ(trigger_with([](verify_trigger_t& t) { t.command = 2; }), "command");
  EXPECT_EQ(trigger_with([](verify_trigger_t& t) { t.alone = 2; }), "alone");
  EXPECT_EQ(task_with([](verify_task_t& t) { t.state = 7; }), "state");
  EXPECT_EQ(task_with([](verify_task_t& t) { t.triggered = 3; }), "triggered");
  EXPECT_EQ(task_with([](verify_task_t& t) { t.has_viewpoint = 2; }), "has_viewpoint");
  EXPECT_EQ(task_with([](verify_task_t& t) { t.appearance[0].kind = 2; }), "appearance[0].kind");
  EXPECT_EQ(result_with([](verify_result_t& r) { r.outcome = 3; }), "outcome");
  EXPECT_EQ(result_with([](verify_result_t& r) { r.has_frame = 2; }), "has_frame");
  EXPECT_EQ(result_with([](verify_result_t& r) { r.frame.view.type = 5; }), "frame.view.type");
  EXPECT_EQ(image_with([](image_t& i) { i.format = 4; }), "format");
  EXPECT_EQ(image_with([](image_t& i) { i.has_pose = 2; }), "has_pose");
}

TEST(VerificationCheckFields, RefusesWhatIsThereTwice) {
  EXPECT_EQ(task_with([](verify_task_t& t) { t.appearance[1].name = "class"; }), "appearance[1]");
  EXPECT_EQ(task_with([](verify_task_t& t) { t.appearance[0].symbols[1] = "cup"; }),
            "appearance[0].symbols[1]");
  EXPECT_EQ(
      result_with([](verify_result_t& r) { r.frame.detections[0].attributes[1].name = "class"; }),
      "frame.detections[0].attributes[1]");
}

TEST(VerificationCheckFields, RefusesTextThatIsTooLongOrNoText) {
  const std::string long_name(kMaxNameBytes + 1, 'a');
  EXPECT_EQ(event_with([&](event_t& e) { e.robot = long_name; }), "robot");
  EXPECT_EQ(event_with([&](event_t& e) { e.object = "\n"; }), "object");
  EXPECT_EQ(event_with([&](event_t& e) { e.other = "\xff"; }), "other");
  EXPECT_EQ(event_with([&](event_t& e) { e.place = long_name; }), "place");
  EXPECT_EQ(event_with([&](event_t& e) { e.sensor = long_name; }), "sensor");
  EXPECT_EQ(trigger_with([](verify_trigger_t& t) { t.description.assign(kMaxTargetBytes, 'a'); }),
            "accepted");
  EXPECT_EQ(
      trigger_with([](verify_trigger_t& t) { t.description.assign(kMaxTargetBytes + 1, 'a'); }),
      "description");
  EXPECT_EQ(trigger_with([&](verify_trigger_t& t) { t.action = long_name; }), "action");
  EXPECT_EQ(task_with([](verify_task_t& t) { t.reason.assign(kMaxReasonBytes, 'a'); }), "accepted");
  EXPECT_EQ(task_with([](verify_task_t& t) { t.reason.assign(kMaxReasonBytes + 1, 'a'); }),
            "reason");
  EXPECT_EQ(result_with([](verify_result_t& r) { r.frame.sensor.clear(); }), "frame.sensor");
  EXPECT_EQ(image_with([](image_t& i) { i.sensor.clear(); }), "sensor");

  Event event;
  event.robot = "amigo";
  Bytes inside = encode(event, 1);
  inside[8 + 8 + 8 + 1 + 4 + 2] = 0;  // after fingerprint, utime, seq, kind and length
  EXPECT_EQ(field_of(decode_event, inside), "robot");
}

TEST(VerificationCheckFields, RefusesWhatIsOverALimit) {
  const auto regions = [](auto& message, std::size_t count) {
    message.regions.resize(count);
    message.num_regions = static_cast<std::int32_t>(count);
  };
  EXPECT_EQ(event_with([&](event_t& e) { regions(e, kMaxRegions); }), "accepted");
  EXPECT_EQ(event_with([&](event_t& e) { regions(e, kMaxRegions + 1); }), "num_regions");
  EXPECT_EQ(task_with([&](verify_task_t& t) { regions(t, kMaxRegions + 1); }), "num_regions");

  Event event = testing::full_event();
  event.regions[1].polygon.resize(kMaxPolygonPoints);
  EXPECT_EQ(field_of(decode_event, encode(event, 1)), "accepted");
  event.regions[1].polygon.emplace_back();
  EXPECT_EQ(field_of(decode_event, encode(event, 1)), "regions[1].num_points");

  TaskMessage task = testing::full_task();
  task.task.tags.resize(kMaxTags);
  EXPECT_EQ(field_of(decode_task, encode(task)), "accepted");
  task.task.tags.push_back(1);
  EXPECT_EQ(field_of(decode_task, encode(task)), "num_tags");
  task = testing::full_task();
  task.task.appearance.assign(kMaxAttributes + 1, {"a", ScalarReport{}});
  EXPECT_EQ(field_of(decode_task, encode(task)), "num_appearance");

  const Bytes large(kMaxMessageBytes + 1);
  const auto refused = decode_task(large);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kTooLarge);
}

TEST(VerificationCheckFields, HoldsAnImageAgainstItsSize) {
  EXPECT_EQ(image_with([](image_t& i) { i.width = 0; }), "width");
  EXPECT_EQ(image_with([](image_t& i) { i.height = -1; }), "height");
  EXPECT_EQ(image_with([](image_t& i) { i.width = kMaxImageSide + 1; }), "width");
  EXPECT_EQ(image_with([](image_t& i) { i.height = 3; }), "num_bytes");
  EXPECT_EQ(image_with([](image_t& i) { i.format = image_t::GRAY8; }), "num_bytes");
  EXPECT_EQ(image_with([](image_t& i) { i.format = image_t::DEPTH16_MM; }), "num_bytes");
  EXPECT_EQ(image_with([](image_t& i) { i.format = image_t::JPEG; }), "accepted");
  EXPECT_EQ(image_with([](image_t& i) {
              i.format = image_t::JPEG;
              i.data.clear();
              i.num_bytes = 0;
            }),
            "num_bytes");

  // An image may be larger than any other message.
  ImageMessage image = testing::full_image();
  image.format = ImageMessage::Format::kJpeg;
  const std::size_t others = encode(image).size() - image.data.size();
  image.data.assign(kMaxImageMessageBytes - others, 7);
  ASSERT_EQ(encode(image).size(), kMaxImageMessageBytes);
  EXPECT_EQ(field_of(decode_image, encode(image)), "accepted");
  image.data.push_back(7);
  const auto refused = decode_image(encode(image));
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kTooLarge);
  EXPECT_EQ(refused.error().message, "the message has more than 32 MiB");
}

}  // namespace
}  // namespace anchord
