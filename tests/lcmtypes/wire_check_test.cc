#include <gtest/gtest.h>

#include <anchord/frame_t.hpp>
#include <anchord/query_t.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/checked_decode.h"
#include "lcmtypes/codec.h"
#include "lcmtypes/names.h"
#include "tests/lcmtypes/sample_frames.h"
#include "tests/lcmtypes/wire_bytes.h"

namespace anchord {
namespace {

using testing::Bytes;
using testing::field_of;
using testing::overwrite;

TEST(WireCheck, NamesTheCountThatLies) {
  Frame frame;
  frame.sensor = "s";
  frame.detections.resize(2);
  for (Detection& detection : frame.detections) {
    detection.measurement = CartesianMeasurement{{1, 2, 3}, {}};
  }
  const Bytes bytes = encode(frame, 1);
  // From the end of the message: a detection without covariance and attributes is kind (1),
  // measurement (24), num_covariance (4), score (9), yaw (9), object (5), num_attributes (4).
  const std::size_t second = bytes.size() - 56, first = second - 56, count = first - 4;
  const std::size_t num_points = count - 4;
  const std::vector<std::pair<std::size_t, std::string>> counts = {
      {num_points, "view.num_points"},
      {count, "num_detections"},
      {first + 25, "detections[0].num_covariance"},
      {second + 25, "detections[1].num_covariance"},
      {second + 47, "detections[1].object"},
      {second + 52, "detections[1].num_attributes"}};
  for (const auto& [at, field] : counts) {
    for (const std::uint32_t lie : {3u, 0xffffu, 0x7fffffffu, 0x80000000u, ~0u}) {
      Bytes changed = bytes;
      overwrite(changed, at, lie);
      EXPECT_EQ(field_of(decode_frame, changed), field) << lie;
    }
  }
}

TEST(WireCheck, RefusesWhatIsOverALimit) {
  Frame frame;
  frame.sensor = "s";
  frame.view = View{};
  frame.view->type = View::Type::kPolygon;
  frame.view->points.resize(kMaxPolygonPoints);
  frame.detections.resize(kMaxDetections);
  for (Detection& detection : frame.detections) {
    detection.measurement = CartesianMeasurement{{0, 0, 0}, {}};
  }
  SymbolReport symbols;
  for (std::size_t i = 0; i < kMaxSymbols; ++i) {
    symbols.probabilities.emplace_back(std::to_string(i), 0.001);
  }
  auto& attributes = frame.detections.front().attributes;
  for (std::size_t i = 0; i < kMaxAttributes; ++i) {
    attributes.push_back(
        {std::to_string(i), i == 0 ? decltype(AttributeReport::value)(symbols) : ScalarReport{}});
  }
  EXPECT_EQ(field_of(decode_frame, encode(frame, 1)), "accepted");

  const auto with = [&](const std::function<void(Frame&)>& change) {
    Frame changed = frame;
    change(changed);
    return field_of(decode_frame, encode(changed, 1));
  };
  EXPECT_EQ(with([](Frame& f) { f.view->points.emplace_back(); }), "view.num_points");
  EXPECT_EQ(with([](Frame& f) { f.detections.push_back(f.detections.back()); }), "num_detections");
  EXPECT_EQ(with([](Frame& f) {
              f.detections[0].attributes.push_back({"a", ScalarReport{}});
            }),
            "detections[0].num_attributes");
  EXPECT_EQ(with([](Frame& f) {
              std::get<SymbolReport>(f.detections[0].attributes[0].value)
                  .probabilities.emplace_back("a", 0.1);
            }),
            "detections[0].attributes[0].num_symbols");
  EXPECT_EQ(with([](Frame& f) { f.robot.assign(kMaxNameBytes + 1, 'r'); }), "robot");
  EXPECT_EQ(with([](Frame& f) { f.sensor.clear(); }), "sensor");
  EXPECT_EQ(with([](Frame& f) { f.detections[7].object = "\xff"; }), "detections[7].object");

  const Bytes large(kMaxMessageBytes + 1);
  const Result<FrameMessage> refused = decode_frame(large);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kTooLarge);
}

TEST(WireCheck, RefusesUnknownEnumeratorsAndBooleans) {
  const auto with = [](const std::function<void(frame_t&)>& change) {
    return testing::field_with<frame_t>(decode_frame, encode(testing::full_frame(), 1), change);
  };
  EXPECT_EQ(with([](frame_t&) {}), "accepted");
  EXPECT_EQ(with([](frame_t& f) { f.view.type = 5; }), "view.type");
  EXPECT_EQ(with([](frame_t& f) { f.view.type = -2; }), "view.type");
  EXPECT_EQ(with([](frame_t& f) { f.has_pose = 2; }), "has_pose");
  EXPECT_EQ(with([](frame_t& f) { f.detections[0].kind = 2; }), "detections[0].kind");
  EXPECT_EQ(with([](frame_t& f) { f.detections[0].kind = detection_t::POLAR; }),
            "detections[0].num_covariance");
  EXPECT_EQ(with([](frame_t& f) { f.detections[1].has_score = -1; }), "detections[1].has_score");
  EXPECT_EQ(with([](frame_t& f) { f.detections[1].has_yaw = 3; }), "detections[1].has_yaw");
  EXPECT_EQ(with([](frame_t& f) { f.detections[0].attributes[0].kind = 2; }),
            "detections[0].attributes[0].kind");
  EXPECT_EQ(with([](frame_t& f) { f.detections[0].attributes[0].kind = attribute_t::SCALAR; }),
            "detections[0].attributes[0].num_symbols");
  EXPECT_EQ(with([](frame_t& f) { f.detections[0].attributes[1].name = "class"; }),
            "detections[0].attributes[1]");
  EXPECT_EQ(with([](frame_t& f) { f.detections[0].attributes[0].symbols[1] = "cup"; }),
            "detections[0].attributes[0].symbols[1]");
}

TEST(WireCheck, RefusesTextThatLcmMisreads) {
  const Frame frame = testing::full_frame();
  Bytes bytes = encode(frame, 1);
  const std::size_t robot = 24;  // after fingerprint, utime and seq
  Bytes changed = bytes;
  overwrite(changed, robot, 0);  // lcm-gen's decoder takes it for a length of -1
  EXPECT_EQ(field_of(decode_frame, changed), "robot");
  changed = bytes;
  changed[robot + 4 + frame.robot.size()] = 'x';
  EXPECT_EQ(field_of(decode_frame, changed), "robot");
  changed = bytes;
  changed[robot + 5] = 0;  // a NUL inside
  EXPECT_EQ(field_of(decode_frame, changed), "robot");
}

TEST(WireCheck, HoldsAQueryAgainstItsBytes) {
  query_t query{};
  query.id = 7;
  query.target = "/v1/where?class=cup";
  const Bytes bytes = encode_message(query);
  for (std::size_t at = 16; at < bytes.size(); ++at) {
    Bytes changed = bytes;
    changed[at] = 0xff;
    EXPECT_FALSE(decode_query(changed).ok()) << at;
  }
  query.target.assign(kMaxTargetBytes + 1, 'a');
  const Result<Query> refused = decode_query(encode_message(query));
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().field, "target");
}

}  // namespace
}  // namespace anchord
