#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <anchord/query_t.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/checked_decode.h"
#include "lcmtypes/codec.h"
#include "lcmtypes/event_codec.h"
#include "lcmtypes/image_codec.h"
#include "lcmtypes/verification_codec.h"
#include "lcmtypes/wire_check.h"
#include "tests/lcmtypes/sample_frames.h"
#include "tests/lcmtypes/sample_verification.h"
#include "tests/lcmtypes/wire_bytes.h"

/// What holds for every type of message that has a checked decoder.
namespace anchord {
namespace {

using testing::Bytes;
using testing::Span;

Bytes encoded(const FrameMessage& message) { return encode(message.frame, message.seq); }
Bytes encoded(const EventMessage& message) { return encode(message.event, message.seq); }
Bytes encoded(const Query& query) {
  query_t message{};
  message.id = query.id;
  message.target = query.target;
  return encode_message(message);
}
template <typename Message>
Bytes encoded(const Message& message) {
  return encode(message);
}

/// A type of message: a valid one, its check, and its decoder followed by its encoder.
struct Codec {
  std::string name;
  Bytes valid;
  Status (*check)(Span);
  std::function<Result<Bytes>(Span)> reencode;
};

template <typename Message>
Codec codec(std::string name, const Message& valid, Status (*check)(Span),
            Result<Message> (*decoder)(Span)) {
  const auto reencode = [decoder](Span bytes) -> Result<Bytes> {
    const auto message = decoder(bytes);
    if (!message) return message.error();
    return encoded(*message);
  };
  return {std::move(name), encoded(valid), check, reencode};
}

std::vector<Codec> codecs() {
  return {codec("frame", FrameMessage{testing::full_frame(), 1}, check_frame, decode_frame),
          codec("query", Query{7, "/v1/where?class=cup"}, check_query, decode_query),
          codec("event", EventMessage{testing::full_event(), 1}, check_event, decode_event),
          codec("trigger", testing::full_trigger(), check_trigger, decode_trigger),
          codec("cancelling", testing::cancelling(), check_trigger, decode_trigger),
          codec("task", testing::full_task(), check_task, decode_task),
          codec("found", testing::full_result(), check_result, decode_result),
          codec("missing", testing::missing_result(), check_result, decode_result),
          codec("pose", testing::full_pose(), check_robot_pose, decode_pose),
          codec("image", testing::full_image(), check_image, decode_image)};
}

class EveryCodec : public ::testing::TestWithParam<Codec> {
 protected:
  /// Refused by the check already, and so by the decoder.
  static bool refused(Span bytes) {
    const bool checked = GetParam().check(bytes).ok();
    const bool decoded = GetParam().reencode(bytes).ok();
    return !checked && !decoded;
  }

  /// Refused, or a message that can be stored and read again.
  static void expect_refused_or_sound(const Bytes& bytes) {
    const Result<Bytes> again = GetParam().reencode(bytes);
    if (!again) return;
    const Result<Bytes> reread = GetParam().reencode(*again);
    ASSERT_TRUE(reread.ok()) << reread.error().text();
    EXPECT_EQ(*reread, *again);
  }
};

TEST_P(EveryCodec, GivesBackAFullMessage) {
  EXPECT_TRUE(GetParam().check(GetParam().valid).ok());
  const Result<Bytes> again = GetParam().reencode(GetParam().valid);
  ASSERT_TRUE(again.ok()) << again.error().text();
  EXPECT_EQ(*again, GetParam().valid);
}

TEST_P(EveryCodec, RefusesEveryTruncation) {
  const Bytes& bytes = GetParam().valid;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_TRUE(refused({bytes.data(), size})) << size;
  }
}

TEST_P(EveryCodec, RefusesTrailingBytesAndOtherTypes) {
  Bytes bytes = GetParam().valid;
  bytes.push_back(0);
  EXPECT_TRUE(refused(bytes));
  for (std::size_t at = 0; at < 8; ++at) {  // the same fields under another fingerprint
    Bytes changed = GetParam().valid;
    changed[at] ^= 1;
    EXPECT_TRUE(refused(changed)) << at;
  }
  for (const Codec& other : codecs()) {
    const bool same = std::equal(bytes.begin(), bytes.begin() + 8, other.valid.begin());
    EXPECT_EQ(GetParam().check(other.valid).ok(), same) << other.name;
    EXPECT_EQ(GetParam().reencode(other.valid).ok(), same) << other.name;
  }
}

TEST_P(EveryCodec, SurvivesEveryBitFlip) {
  const Bytes& bytes = GetParam().valid;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    Bytes flipped = bytes;
    flipped[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    expect_refused_or_sound(flipped);
  }
}

TEST_P(EveryCodec, SurvivesEveryLieInFourBytes) {
  const Bytes& bytes = GetParam().valid;
  for (std::size_t at = 0; at + 4 <= bytes.size(); ++at) {
    for (const std::uint32_t lie : {0u, 1u, 0x100u, 0xffffu, 0x7fffffffu, 0x80000000u, ~0u}) {
      Bytes changed = bytes;
      testing::overwrite(changed, at, lie);
      expect_refused_or_sound(changed);
    }
  }
}

TEST_P(EveryCodec, SurvivesRandomBytes) {
  const Bytes& valid = GetParam().valid;
  EXPECT_TRUE(rc::check("random bytes behind a valid start", [&] {
    const auto kept = *rc::gen::inRange<std::size_t>(0, valid.size());
    const auto tail = *rc::gen::arbitrary<Bytes>();
    Bytes bytes(valid.begin(), valid.begin() + static_cast<long>(kept));
    bytes.insert(bytes.end(), tail.begin(), tail.end());
    expect_refused_or_sound(bytes);
    RC_ASSERT(!::testing::Test::HasFailure());
  }));
}

INSTANTIATE_TEST_SUITE_P(Each, EveryCodec, ::testing::ValuesIn(codecs()),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace anchord
