#include "lcmtypes/codec.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <anchord/frame_t.hpp>
#include <anchord/query_t.hpp>
#include <limits>

#include "lcmtypes/checked_decode.h"
#include "tests/lcmtypes/random_frames.h"
#include "tests/lcmtypes/sample_frames.h"

namespace anchord {
namespace {

using Bytes = std::vector<std::uint8_t>;

Frame decoded(const Bytes& bytes) {
  const Result<FrameMessage> message = decode_frame(bytes);
  EXPECT_TRUE(message.ok()) << message.error().text();
  return message ? message->frame : Frame{};
}

TEST(Codec, GivesBackAFullFrame) {
  const Frame frame = testing::full_frame();
  const Result<FrameMessage> message = decode_frame(encode(frame, 42));
  ASSERT_TRUE(message.ok()) << message.error().text();
  EXPECT_EQ(message->frame, frame);
  EXPECT_EQ(message->seq, 42);
}

TEST(Codec, GivesBackRandomFrames) {
  EXPECT_TRUE(rc::check("decode undoes encode, and encode decode", [] {
    const Frame frame = testing::random_frame();
    const auto seq = *rc::gen::arbitrary<std::int64_t>();
    const Bytes bytes = encode(frame, seq);
    const Result<FrameMessage> message = decode_frame(bytes);
    RC_ASSERT(message.ok());
    RC_ASSERT(message->frame == frame);
    RC_ASSERT(message->seq == seq);
    RC_ASSERT(encode(message->frame, message->seq) == bytes);
  }));
}

TEST(Codec, WritesWhatLcmGenReads) {
  const Frame frame = testing::full_frame();
  const Bytes bytes = encode(frame, 1);
  frame_t message;
  ASSERT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
            static_cast<int>(bytes.size()));
  EXPECT_EQ(message.utime, frame.utime);
  EXPECT_EQ(message.sensor, frame.sensor);
  EXPECT_EQ(message.view.type, view_t::SECTOR);
  ASSERT_EQ(message.num_detections, 3);
  EXPECT_EQ(message.detections[0].num_covariance, 9);
  EXPECT_EQ(message.detections[0].attributes[0].symbols[0], "cup");
  EXPECT_EQ(message.detections[1].kind, detection_t::POLAR);
  EXPECT_EQ(message.detections[2].num_covariance, 4);
}

TEST(Codec, TheNumberIsNoContent) {
  const Frame frame = testing::full_frame();
  EXPECT_NE(encode(frame, 1), encode(frame, 2));
  EXPECT_EQ(canonical_bytes(decoded(encode(frame, 1))), canonical_bytes(decoded(encode(frame, 2))));
}

/// Publishers leave what they do not use as it comes: a C++ program even uninitialised.
TEST(Codec, UnusedNumbersDoNotMatter) {
  frame_t message{};
  message.utime = 5;
  message.sensor = "s";
  message.view.type = view_t::WORLD;
  message.num_detections = 1;
  message.detections.resize(1);
  message.detections[0].num_covariance = 4;
  message.detections[0].covariance = {1, 0, 0, 1};
  const Frame plain = decoded(encode_message(message));
  const double garbage = std::numeric_limits<double>::quiet_NaN();
  message.pose.position[0] = garbage;
  message.view.range[1] = message.view.bearing[0] = message.view.elevation[0] = garbage;
  message.view.hfov = garbage;
  message.detections[0].score = message.detections[0].yaw = garbage;
  message.detections[0].measurement[2] = garbage;
  EXPECT_EQ(decoded(encode_message(message)), plain);
}

TEST(Codec, TheCovarianceSaysHowManyNumbersAPositionHas) {
  Frame frame;
  frame.sensor = "s";
  frame.detections.resize(3);
  frame.detections[0].measurement = CartesianMeasurement{{1, 2}, {1, 0, 0, 1}};
  frame.detections[1].measurement = CartesianMeasurement{{1, 2, 3}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  frame.detections[2].measurement = CartesianMeasurement{{1, 2}, {}};
  Frame expected = frame;
  expected.detections[2].measurement = CartesianMeasurement{{1, 2, 0}, {}};
  const Bytes bytes = encode(frame, 0);
  EXPECT_EQ(decoded(bytes), expected);
  EXPECT_EQ(canonical_bytes(decoded(bytes)), bytes);
}

TEST(Codec, KeepsNumbersThatAreNone) {
  Frame frame = testing::full_frame();
  frame.detections[0].score = std::numeric_limits<double>::quiet_NaN();
  frame.detections[1].yaw = -std::numeric_limits<double>::infinity();
  const Bytes bytes = encode(frame, 3);
  EXPECT_EQ(encode(decoded(bytes), 3), bytes);
}

TEST(Codec, AViewThatIsNotGivenIsTheConfiguredOne) {
  Frame frame = testing::full_frame();
  frame.view.reset();
  EXPECT_FALSE(decoded(encode(frame, 1)).view.has_value());
  frame.view = View{};
  EXPECT_EQ(decoded(encode(frame, 1)).view->type, View::Type::kNone);
}

TEST(Codec, RefusesCountsThatNoDecoderMakes) {
  Frame frame = testing::full_frame();
  frame.detections[1].measurement = PolarMeasurement{1, 0, 0, {1, 1}};
  const Result<FrameMessage> message = decode_frame(encode(frame, 1));
  ASSERT_FALSE(message.ok());
  EXPECT_EQ(message.error().field, "detections[1].num_covariance");
}

TEST(CodecDeathTest, AbortsOnAMalformedFrame) {
  Frame frame = testing::full_frame();
  frame.sensor = std::string("a\0b", 3);
  EXPECT_DEATH((void)encode(frame, 1), "NUL");
  frame = testing::full_frame();
  frame.detections[0].measurement = CartesianMeasurement{{1}, {}};
  EXPECT_DEATH((void)encode(frame, 1), "2 or 3 numbers");
}

TEST(Codec, ReadsAQuery) {
  query_t query{};
  query.id = -3;
  query.target = "/v1/where?class=cup";
  const Result<Query> read = decode_query(encode_message(query));
  ASSERT_TRUE(read.ok()) << read.error().text();
  EXPECT_EQ(*read, (Query{-3, "/v1/where?class=cup"}));
}

}  // namespace
}  // namespace anchord
