// What bad frames get: a refusal that names the field, a counter, and an unchanged belief.

#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

using Json = nlohmann::json;

struct BadBody {
  std::string what, body;
  int status;
  std::string field;
};

/// A good frame after the first, changed at a place in it.
std::string with(const std::string& pointer, const Json& value) {
  Json frame = to_json(frame_number(2));
  frame[Json::json_pointer(pointer)] = value;
  return frame.dump();
}

std::string without(const std::string& member) {
  Json frame = to_json(frame_number(2));
  frame.erase(member);
  return frame.dump();
}

std::string covariance(double xx, double xy, double yx) {
  return with("/detections/1/covariance", {xx, xy, 0, yx, 1e-3, 0, 0, 0, 1e-3});
}

std::string posed(Json orientation, double variance) {
  std::vector<double> uncertain(36, 0.0);
  uncertain[0] = variance;
  return with("/pose", {{"position", {0, 0, 1}},
                        {"orientation", std::move(orientation)},
                        {"covariance", uncertain}});
}

std::string many_detections(std::size_t count) {
  Json frame = to_json(frame_number(2));
  const Json one = {{"position", {1, 1, 1}}};
  frame["detections"] = Json(count, one);
  return frame.dump();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

std::vector<BadBody> bad_bodies() {
  const std::string good = json(frame_number(2));
  const std::string p = "detections[1].";
  return {
      {"nothing", "", 400, ""},
      {"cut off", good.substr(0, good.size() / 2), 400, ""},
      {"more behind it", good + "}", 400, ""},
      {"deep nesting", std::string(100'000, '['), 400, ""},
      {"a number", "7", 400, ""},
      {"NaN", replaced(good, "\"utime\"", "\"x\":NaN,\"utime\""), 400, ""},
      {"beyond any double", replaced(good, "0.0,", "1e999,"), 400, ""},
      {"no sensor", without("sensor"), 400, "sensor"},
      {"no detections", without("detections"), 400, "detections"},
      {"text for a time", with("/utime", "now"), 400, "utime"},
      {"1970", with("/utime", 0), 400, "utime"},
      {"3000", with("/utime", 32'503'680'000'000'000), 400, "utime"},
      {"runs backwards", with("/utime", kStart + 1), 409, "utime"},
      {"another at the same time", with("/utime", frame_number(1).utime), 409, "utime"},
      {"long behind", with("/utime", kStart - 60'000'000), 409, "utime"},
      {"100,000 detections", many_detections(100'000), 400, "detections"},
      {"two coordinates", with("/detections/1/position", {1, 2}), 400, p},
      {"a null in a position", with("/detections/1/position", {1, 2, nullptr}), 400,
       p + "position"},
      {"eight numbers", with("/detections/1/covariance", std::vector<double>(8, 1.0)), 400,
       p + "covariance"},
      {"negative variance", covariance(-1e-3, 0, 0), 400, p + "covariance"},
      {"indefinite", covariance(1e-3, 1e-2, 1e-2), 400, p + "covariance"},
      {"not symmetric", covariance(1e-3, 5e-4, 0), 400, p + "covariance"},
      {"score over 1", with("/detections/1/score", 1.5), 400, p + "score"},
      {"probability over 1", with("/detections/1/attributes/class/cup", 1.5), 400,
       p + "attributes.class"},
      {"negative probability", with("/detections/1/attributes/class/cup", -0.1), 400,
       p + "attributes.class.cup"},
      {"all zero", with("/detections/1/attributes/class", {{"cup", 0.0}}), 400,
       p + "attributes.class"},
      {"sum over 1", with("/detections/1/attributes/class", {{"cup", 0.7}, {"tea_box", 0.7}}), 400,
       p + "attributes.class"},
      {"unknown symbol", with("/detections/1/attributes/class/mug", 0.1), 400,
       p + "attributes.class.mug"},
      {"unknown attribute", with("/detections/1/attributes/weight/heavy", 0.1), 400,
       p + "attributes.weight"},
      {"scalar without variance", with("/detections/1/attributes/size/mean", 0.1), 400,
       p + "attributes.size.variance"},
      {"quaternion of norm 0", posed({0, 0, 0, 0}, 0), 400, "pose.orientation"},
      {"negative pose variance", posed({1, 0, 0, 0}, -1), 400, "pose.covariance"},
      {"unknown view", with("/view/type", "sphere"), 400, "view.type"},
      {"one bad of two", "[" + good + "," + replaced(covariance(-1, 0, 0), "kinect", "laser") + "]",
       400, "[1]." + p + "covariance"},
      {"one malformed of two", "[" + good + ",{}]", 400, "[1].utime"},
      {"5,000 frames", Json(5'000, to_json(frame_number(2))).dump(), 413, ""},
  };
}

TEST(BadInput, IsRefusedAndChangesNothing) {
  TestFolder folder;
  DaemonProcess daemon(folder);
  ASSERT_TRUE(daemon.ready());
  const auto port = daemon.port();
  ASSERT_EQ(ask(port, post("/v1/detections", json(frame_number(1)))).status, 200);
  const std::string before = belief(port);
  for (const auto& [what, bad, status, field] : bad_bodies()) {
    const auto refused = counter(port, "/frames/refused");
    const Answer answer = ask(port, post("/v1/detections", bad));
    EXPECT_EQ(answer.status, status) << what << ": " << answer.body;
    const Json error = Json::parse(answer.body)["error"];
    EXPECT_EQ(error.value("field", "").find(field), 0u) << what << ": " << error;
    EXPECT_NE(error.value("message", ""), "") << what;
    EXPECT_GT(counter(port, "/frames/refused"), refused) << what;
    EXPECT_EQ(belief(port), before) << what;
  }
  EXPECT_EQ(counter(port, "/log/frames"), 1);
  EXPECT_EQ(ask(port, post("/v1/detections", json(frame_number(2)))).status, 200)
      << "nothing of it was taken";
}

TEST(BadInput, ABodyOverTheLimit) {
  TestFolder folder;
  DaemonProcess daemon(folder);
  ASSERT_TRUE(daemon.ready());
  // Announced, and not sent: 9 MiB where 8 are allowed (HttpLimits).
  Client client(daemon.port());
  const Answer answer = client.ask(
      "POST /v1/detections HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
      "Content-Length: 9437184\r\n\r\n");
  EXPECT_EQ(answer.status, 413);
  EXPECT_EQ(counter(daemon.port(), "/http/client_errors"), 1);
}

}  // namespace
}  // namespace anchord
