#include "api/frame_json.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "api/json_text.h"
#include "lcmtypes/codec.h"
#include "lcmtypes/names.h"
#include "tests/lcmtypes/random_frames.h"
#include "tests/lcmtypes/sample_frames.h"

namespace anchord {
namespace {

using nlohmann::json;

/// The field that is refused after a change to the full frame.
std::string field_after(const std::function<void(json&)>& change) {
  json value = to_json(testing::full_frame());
  change(value);
  const Result<Frame> frame = parse_frame(value.dump());
  return frame ? "accepted" : frame.error().field;
}

std::string message_of(const std::string& text) {
  const Result<Frame> frame = parse_frame(text);
  return frame ? "accepted" : frame.error().message;
}

TEST(FrameJson, ReadsEveryField) {
  const std::string text = R"({"utime": 1700000000000000, "sensor": "kinect", "robot": "amigo",
    "pose": {"position": [0, 0, 1.2], "orientation": [1, 0, 0, 0]},
    "view": {"type": "sector", "range": [0.3, 5], "bearing": [-0.5, 0.5]},
    "detections": [
      {"position": [1.0, 0.2, 0.9], "covariance": [1, 0, 0, 0, 1, 0, 0, 0, 1], "score": 0.9,
       "yaw": -0.5, "object": "cup-1",
       "attributes": {"class": {"cup": 0.8}, "size": {"mean": 0.12, "variance": 0.0004}}},
      {"polar": {"range": 2, "bearing": 0.1, "elevation": 0, "variance": [1, 2, 3]}},
      {"position": [1, 2], "unknown": {"is": "ignored"}}]})";
  const Result<Frame> frame = parse_frame(text);
  ASSERT_TRUE(frame.ok()) << frame.error().text();

  Frame expected;
  expected.utime = 1'700'000'000'000'000;
  expected.sensor = "kinect";
  expected.robot = "amigo";
  expected.pose = Pose{{0, 0, 1.2}, {1, 0, 0, 0}, {}};
  expected.view = View{};
  expected.view->type = View::Type::kSector;
  expected.view->range = {0.3, 5};
  expected.view->bearing = {-0.5, 0.5};
  expected.detections.resize(3);
  Detection& cup = expected.detections[0];
  cup.measurement = CartesianMeasurement{{1, 0.2, 0.9}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  cup.score = 0.9;
  cup.yaw = -0.5;
  cup.object = "cup-1";
  cup.attributes = {{"class", SymbolReport{{{"cup", 0.8}}}}, {"size", ScalarReport{0.12, 4e-4}}};
  expected.detections[1].measurement = PolarMeasurement{2, 0.1, 0, {1, 2, 3}};
  expected.detections[2].measurement = CartesianMeasurement{{1, 2}, {}};
  EXPECT_EQ(*frame, expected);
}

TEST(FrameJson, ReadsEveryView) {
  const auto type_of = [](const std::string& view) {
    const Result<Frame> frame =
        parse_frame(R"({"utime":1,"sensor":"s","detections":[],"view":)" + view + "}");
    return frame ? static_cast<int>(frame->view->type) : -1;
  };
  EXPECT_EQ(type_of(R"({"type":"none"})"), static_cast<int>(View::Type::kNone));
  EXPECT_EQ(type_of(R"({"type":"world"})"), static_cast<int>(View::Type::kWorld));
  EXPECT_EQ(type_of(R"({"type":"sector","range":[0,1],"bearing":[0,1]})"),
            static_cast<int>(View::Type::kSector));
  EXPECT_EQ(type_of(R"({"type":"frustum","range":[0,1],"hfov":1,"vfov":1})"),
            static_cast<int>(View::Type::kFrustum));
  EXPECT_EQ(type_of(R"({"type":"polygon","points":[[0,0],[1,0],[0,1]]})"),
            static_cast<int>(View::Type::kPolygon));
}

TEST(FrameJson, NamesTheFieldThatIsWrong) {
  const auto at = [](const char* pointer, json value) {
    return field_after([&](json& frame) { frame[json::json_pointer(pointer)] = value; });
  };
  EXPECT_EQ(field_after([](json&) {}), "accepted");
  EXPECT_EQ(at("/utime", 1.5), "utime");
  EXPECT_EQ(at("/utime", "1700000000000000"), "utime");
  EXPECT_EQ(at("/utime", std::numeric_limits<std::uint64_t>::max()), "utime");
  EXPECT_EQ(at("/sensor", 3), "sensor");
  EXPECT_EQ(at("/sensor", ""), "sensor");
  EXPECT_EQ(at("/sensor", std::string("a\0b", 3)), "sensor");
  EXPECT_EQ(at("/robot", std::string(kMaxNameBytes + 1, 'r')), "robot");
  EXPECT_EQ(at("/pose", nullptr), "pose");
  EXPECT_EQ(at("/pose/position", {1, 2}), "pose.position");
  EXPECT_EQ(at("/pose/orientation/2", "x"), "pose.orientation[2]");
  EXPECT_EQ(at("/pose/covariance", json::array()), "pose.covariance");
  EXPECT_EQ(at("/view", "world"), "view");
  EXPECT_EQ(at("/view/type", "cone"), "view.type");
  EXPECT_EQ(at("/view/type", "frustum"), "view.hfov");
  EXPECT_EQ(at("/view/range", {1, 2, 3}), "view.range");
  EXPECT_EQ(at("/view/elevation", 3), "view.elevation");
  EXPECT_EQ(at("/detections", json::object()), "detections");
  EXPECT_EQ(at("/detections/1", json::array()), "detections[1]");
  EXPECT_EQ(at("/detections/1", json::object()), "detections[1]");
  EXPECT_EQ(at("/detections/1/position", {1, 2, 3}), "detections[1]");
  EXPECT_EQ(at("/detections/0/position", {1}), "detections[0].position");
  EXPECT_EQ(at("/detections/0/position/1", true), "detections[0].position[1]");
  EXPECT_EQ(at("/detections/0/covariance", {1, 0, 0, 1}), "detections[0].covariance");
  EXPECT_EQ(at("/detections/0/covariance/8", nullptr), "detections[0].covariance[8]");
  EXPECT_EQ(at("/detections/1/polar/variance", {1, 2}), "detections[1].polar.variance");
  EXPECT_EQ(at("/detections/1/polar/range", "far"), "detections[1].polar.range");
  EXPECT_EQ(at("/detections/0/score", "high"), "detections[0].score");
  EXPECT_EQ(at("/detections/0/yaw", json::array()), "detections[0].yaw");
  EXPECT_EQ(at("/detections/0/object", 12), "detections[0].object");
  EXPECT_EQ(at("/detections/0/attributes", json::array()), "detections[0].attributes");
  EXPECT_EQ(at("/detections/0/attributes/class", "cup"), "detections[0].attributes.class");
  EXPECT_EQ(at("/detections/0/attributes/class/cup", "p"), "detections[0].attributes.class.cup");
  EXPECT_EQ(at("/detections/0/attributes/size", {{"mean", 1}}),
            "detections[0].attributes.size.variance");
  EXPECT_EQ(at("/detections/0/attributes/class", {{"", 1}}), "detections[0].attributes.class");
}

TEST(FrameJson, NamesTheFieldThatIsMissing) {
  for (const char* key : {"utime", "sensor", "detections"}) {
    EXPECT_EQ(field_after([&](json& frame) { frame.erase(key); }), key);
  }
  for (const char* key : {"position", "orientation"}) {
    EXPECT_EQ(field_after([&](json& frame) { frame["pose"].erase(key); }),
              std::string("pose.") + key);
  }
  for (const char* key : {"range", "bearing"}) {
    EXPECT_EQ(field_after([&](json& frame) { frame["detections"][1]["polar"].erase(key); }),
              std::string("detections[1].polar.") + key);
  }
}

TEST(FrameJson, RefusesMoreThanTheLimits) {
  const json detection = {{"position", {0, 0, 0}}};
  const auto with = [&](std::size_t count) {
    return field_after([&](json& f) { f["detections"] = json::array_t(count, detection); });
  };
  EXPECT_EQ(with(kMaxDetections), "accepted");
  EXPECT_EQ(with(kMaxDetections + 1), "detections");
  EXPECT_EQ(with(100'000), "detections");
  EXPECT_EQ(field_after([&](json& f) {
              f["view"] = {{"type", "polygon"},
                           {"points", json::array_t(kMaxPolygonPoints + 1, json{0, 0})}};
            }),
            "view.points");
  const auto members = [](std::size_t count, const json& value) {
    json object = json::object();
    for (std::size_t i = 0; i < count; ++i) object[std::to_string(i)] = value;
    return object;
  };
  EXPECT_EQ(field_after([&](json& f) {
              f["detections"][0]["attributes"] = members(kMaxAttributes + 1, {{"a", 1}});
            }),
            "detections[0].attributes");
  EXPECT_EQ(field_after([&](json& f) {
              f["detections"][0]["attributes"]["class"] = members(kMaxSymbols + 1, 0.001);
            }),
            "detections[0].attributes.class");
}

TEST(FrameJson, RefusesWhatIsNoJson) {
  EXPECT_EQ(message_of(R"({"utime": 1,)"), "not valid JSON at byte 13");
  for (const char* text : {"", "{", "nul", "{}x", "[1,]", "{\"a\":NaN}", "{\"a\":Infinity}", "\xff",
                           "{\"sensor\":\"\xc3\"}"}) {
    EXPECT_NE(message_of(text).find("not valid JSON"), std::string::npos) << text;
  }
  EXPECT_NE(message_of(R"({"utime": 1e999})").find("out of range"), std::string::npos);
  EXPECT_NE(message_of(R"({"a": 1, "b": {"c": 1, "c": 2}})").find("twice"), std::string::npos);
  EXPECT_EQ(message_of(R"([])"), "must be an object");
}

TEST(FrameJson, BoundsDepthAndSize) {
  const auto nested = [](std::size_t depth) {
    return std::string(depth, '[') + std::string(depth, ']');
  };
  EXPECT_TRUE(parse_json(nested(kMaxJsonDepth)).ok());
  EXPECT_FALSE(parse_json(nested(kMaxJsonDepth + 1)).ok());
  EXPECT_FALSE(parse_json(nested(1'000'000)).ok());
  EXPECT_FALSE(parse_json(std::string(1'000'000, '[')).ok());
  const Result<json> large = parse_json(std::string(kMaxMessageBytes + 1, ' '));
  ASSERT_FALSE(large.ok());
  EXPECT_EQ(large.error().code, ErrorCode::kTooLarge);
}

TEST(FrameJson, ReadsOneFrameOrMany) {
  const json frame = to_json(testing::full_frame());
  const Result<std::vector<Frame>> one = parse_frames(frame.dump());
  ASSERT_TRUE(one.ok());
  EXPECT_EQ(one->size(), 1u);
  const Result<std::vector<Frame>> many = parse_frames(json{frame, frame, frame}.dump());
  ASSERT_TRUE(many.ok());
  EXPECT_EQ(*many, std::vector<Frame>(3, testing::full_frame()));
  EXPECT_TRUE(parse_frames("[]")->empty());

  json broken = frame;
  broken["detections"][1]["polar"]["range"] = "far";
  const Result<std::vector<Frame>> refused = parse_frames(json{frame, frame, broken}.dump());
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().field, "[2].detections[1].polar.range");
}

TEST(FrameJson, GivesBackRandomFrames) {
  EXPECT_TRUE(rc::check("parse undoes to_json", [] {
    const Frame frame = testing::random_frame();
    const Result<Frame> read = parse_frame(to_json(frame).dump());
    RC_ASSERT(read.ok());
    RC_ASSERT(*read == frame);
    RC_ASSERT(canonical_bytes(*read) == canonical_bytes(frame));  // tells 0 from -0
  }));
}

TEST(FrameJson, SurvivesEveryBitFlipAndTruncation) {
  const std::string text = to_json(testing::full_frame()).dump();
  for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
    std::string flipped = text;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    const Result<Frame> frame = parse_frame(flipped);
    if (frame) {
      EXPECT_EQ(*parse_frame(to_json(*frame).dump()), *frame);
    } else {
      EXPECT_NO_THROW((void)json(frame.error().text()).dump());  // an answer carries it
    }
  }
  for (std::size_t size = 0; size < text.size(); ++size) {
    EXPECT_FALSE(parse_frame(text.substr(0, size)).ok()) << size;
  }
}

TEST(FrameJson, RefusesNumbersThatJsonTextCannotHold) {
  json value = to_json(testing::full_frame());
  value["detections"][0]["score"] = std::numeric_limits<double>::quiet_NaN();
  const Result<Frame> frame = frame_from_json(value);
  ASSERT_FALSE(frame.ok());
  EXPECT_EQ(frame.error().field, "detections[0].score");
}

}  // namespace
}  // namespace anchord
