// Triggers, tasks, results and events over HTTP, with the program itself.

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

using nlohmann::json;

/// p_D of kScene, for the mass that a miss moves.
constexpr double kDetected = 0.9;

class VerificationTest : public ::testing::Test {
 protected:
  void SetUp() override {
    start();
    for (int i = 1; i <= 5; ++i)
      ASSERT_EQ(ask(port(), post("/v1/detections", ::anchord::json(frame_number(i)))).status, 200);
  }
  void start() {
    DaemonProcess::Options options;
    options.scene = scene_;
    daemon_ = std::make_unique<DaemonProcess>(folder_, options);
    ASSERT_TRUE(daemon_->ready());
  }
  std::uint16_t port() const { return daemon_->port(); }
  json got(const std::string& target) { return json::parse(body(port(), target)); }
  Answer send(const std::string& target, const json& what) {
    return ask(port(), post(target, what.dump()));
  }
  /// A trigger's task once it is issued.
  json issued(const json& trigger) {
    const Answer answer = send("/v1/verifications", trigger);
    EXPECT_EQ(answer.status, 201) << answer.body;
    const std::string path = "/v1/verifications/" + json::parse(answer.body)["id"].dump();
    EXPECT_TRUE(eventually([&] { return got(path)["state"] == "issued"; }));
    return got(path);
  }
  json where(const std::string& object) {
    return got("/v1/where?object=" + object)["answers"].at(0);
  }
  static double mass(const json& answer, const std::string& place) {
    for (const json& one : answer["places"])
      if (one["place"] == place) return one["p"];
    return 0;
  }
  /// A frame with the cup alone, seen at x = 2.1 m.
  json found_frame(int number) {
    Frame frame = frame_number(number, "verifier");
    frame.view->type = View::Type::kNone;
    frame.detections.resize(1);
    std::get<CartesianMeasurement>(frame.detections[0].measurement).position[0] = 2.1;
    return to_json(frame);
  }

  std::string scene_ = kScene;
  TestFolder folder_;
  std::unique_ptr<DaemonProcess> daemon_;
};

TEST_F(VerificationTest, AFoundObjectIsUpdatedAndItsTaskEnds) {
  const json task = issued({{"object", "cup-1"}, {"tag", 7}});
  EXPECT_EQ(task["class"], "cup");
  EXPECT_EQ(task["tags"], json::array({7}));
  ASSERT_EQ(task["regions"].size(), 1u);
  EXPECT_NEAR(task["regions"][0]["center"][0].get<double>(), 2, 0.05) << "where frames have it";
  EXPECT_NEAR(task["appearance"]["color"]["red"].get<double>(), 1, 0.01);

  const std::string result = "/v1/verifications/" + task["id"].dump() + "/result";
  const Answer done = send(result, {{"outcome", "found"}, {"frame", found_frame(6)}});
  ASSERT_EQ(done.status, 200) << done.body;
  EXPECT_EQ(json::parse(done.body)["state"], "found");
  EXPECT_EQ(where("cup-1")["last_seen"], frame_number(6).utime);

  const Answer again = send(result, {{"outcome", "occluded"}});
  EXPECT_EQ(again.status, 409) << "it has ended";
  EXPECT_EQ(send("/v1/verifications/99/result", {{"outcome", "occluded"}}).status, 404);
}

TEST_F(VerificationTest, AMissingObjectIsSomewhereElseAndStillExists) {
  const json task = issued({{"class", "cup"}, {"color", "red"}});
  EXPECT_EQ(task["object"], "cup-1");
  const double p_before = where("cup-1")["p"];
  const Answer done =
      send("/v1/verifications/" + task["id"].dump() + "/result",
           {{"outcome", "missing"}, {"utime", frame_number(5).utime}, {"sensor", "kinect"}});
  ASSERT_EQ(done.status, 200) << done.body;
  const json after = where("cup-1");
  EXPECT_DOUBLE_EQ(after["p"], p_before);
  // What moved is uniform over the world, of which the kitchen is half, but for the small region
  // (its share of the world is below 1e-3).
  EXPECT_NEAR(mass(after, "kitchen"), 1 - kDetected / 2, 1e-3);
}

TEST_F(VerificationTest, OccludedChangesNothing) {
  const json task = issued({{"object", "cup-1"}});
  const std::string before = belief(port());
  ASSERT_EQ(
      send("/v1/verifications/" + task["id"].dump() + "/result", {{"outcome", "occluded"}}).status,
      200);
  EXPECT_EQ(belief(port()), before);
}

TEST_F(VerificationTest, ARestartInTheMiddleOfATaskKeepsIt) {
  const json task = issued({{"object", "cup-1"}, {"timeout", 600}});
  const json waits =
      json::parse(send("/v1/verifications", {{"object", "tea_box-1"}, {"timeout", 600}}).body);
  const std::string before = belief(port());
  daemon_->end(SIGKILL);
  start();
  EXPECT_EQ(belief(port()), before);
  EXPECT_EQ(got("/v1/verifications/" + task["id"].dump())["state"], "issued");
  EXPECT_EQ(got("/v1/verifications/" + waits["id"].dump())["state"], "queued");
  const Answer done = send("/v1/verifications/" + task["id"].dump() + "/result",
                           {{"outcome", "found"}, {"frame", found_frame(6)}});
  EXPECT_EQ(done.status, 200) << done.body;
  EXPECT_TRUE(eventually(
      [&] { return got("/v1/verifications/" + waits["id"].dump())["state"] == "issued"; }));
  const json next = json::parse(send("/v1/verifications", {{"object", "cup-1"}}).body);
  EXPECT_GT(next["id"], waits["id"]) << "numbers are not given again";
}

/// kScene with a round place of very many corners.
class ManyCornersTest : public VerificationTest {
 protected:
  ManyCornersTest() {
    json scene = json::parse(kScene);
    json round = json::array();
    for (int i = 0; i < kMaxCorners; ++i)
      round.push_back(
          {5 + std::cos(2 * M_PI * i / kMaxCorners), 4 + std::sin(2 * M_PI * i / kMaxCorners)});
    scene["places"].push_back({{"name", "rug"}, {"kind", "surface"}, {"polygon", round}});
    scene_ = scene.dump();
  }
  static constexpr int kMaxCorners = 1000;  // that a configuration may have
};

TEST_F(ManyCornersTest, ATaskForAPlaceOfManyCornersSurvivesARestart) {
  ASSERT_EQ(send("/v1/events", {{"utime", frame_number(5).utime},
                                {"event", "moved"},
                                {"object", "cup-1"},
                                {"place", "rug"}})
                .status,
            200);
  const json task = issued({{"object", "cup-1"}, {"timeout", 600}});
  daemon_->end(SIGKILL);
  start();
  EXPECT_EQ(got("/v1/verifications/" + task["id"].dump())["state"], "issued");
}

TEST_F(VerificationTest, TasksExpireAndAreCancelled) {
  const json brief = issued({{"object", "cup-1"}, {"timeout", 0.3}});
  const std::string path = "/v1/verifications/" + brief["id"].dump();
  EXPECT_TRUE(eventually([&] { return got(path)["state"] == "expired"; }));
  const json other = issued({{"object", "cup-1"}});
  const std::string other_path = "/v1/verifications/" + other["id"].dump();
  EXPECT_EQ(ask(port(), "DELETE " + other_path + " HTTP/1.1\r\nHost: localhost\r\n\r\n").status,
            200);
  EXPECT_EQ(got(other_path)["state"], "cancelled");
}

TEST_F(VerificationTest, RefusalsNameTheField) {
  const struct {
    std::string target;
    json body;
    int status;
    std::string field;
  } cases[] = {
      {"/v1/verifications", {{"object", "cup-9"}}, 404, "object"},
      {"/v1/verifications", json::object(), 400, "object"},
      {"/v1/verifications", {{"object", "cup-1"}, {"class", "cup"}}, 400, "object"},
      {"/v1/verifications", {{"class", "mug"}}, 400, "description.class"},
      {"/v1/verifications", {{"class", "cup&color=red"}}, 400, "description.class"},
      {"/v1/verifications", {{"object", "cup-1"}, {"timeout", -1}}, 400, "timeout"},
      {"/v1/verifications", {{"object", "cup-1"}, {"action", "juggle"}}, 400, "action"},
      {"/v1/verifications/1/result", {{"outcome", "lost"}}, 400, "outcome"},
      {"/v1/verifications/1/result", {{"outcome", "missing"}}, 400, "utime"},
      {"/v1/events", {{"utime", kStart}, {"event", "eaten"}, {"object", "cup-1"}}, 400, "event"},
      {"/v1/events", {{"utime", kStart}, {"event", "grasped"}, {"object", "cup-9"}}, 404, "object"},
      {"/v1/events",
       {{"utime", kStart}, {"event", "placed"}, {"object", "cup-1"}, {"place", "attic"}},
       400,
       "place"}};
  const std::string before = belief(port());
  for (const auto& one : cases) {
    const Answer answer = send(one.target, one.body);
    EXPECT_EQ(answer.status, one.status) << one.body << answer.body;
    EXPECT_EQ(json::parse(answer.body)["error"]["field"], one.field) << one.body << answer.body;
  }
  EXPECT_EQ(belief(port()), before);
  EXPECT_EQ(got("/v1/verifications")["verifications"].size(), 0u);
}

TEST_F(VerificationTest, AFloodOfTriggersIsBoundedAndFramesStillPass) {
  int taken = 0, refused = 0;
  for (int i = 0; i < 400; ++i) {
    const int status = send("/v1/verifications", {{"object", "cup-1"}, {"alone", true}}).status;
    taken += status == 201;
    refused += status == 503;
  }
  EXPECT_EQ(taken + refused, 400);
  EXPECT_GT(refused, 100) << "256 may wait";
  EXPECT_EQ(ask(port(), post("/v1/detections", ::anchord::json(frame_number(6)))).status, 200);
}

TEST_F(VerificationTest, EventsAreLoggedAndUndone) {
  const Utime now = frame_number(5).utime;
  const auto tell = [&](json event) {
    event["utime"] = now;
    const Answer answer = send("/v1/events", event);
    EXPECT_EQ(answer.status, 200) << answer.body;
    return json::parse(answer.body);
  };
  tell({{"event", "named"}, {"object", "cup-1"}, {"name", "my mug"}});
  EXPECT_EQ(got("/v1/objects/my%20mug")["id"], "cup-1");
  const json dropped = tell({{"event", "dropped"}, {"object", "my mug"}});
  EXPECT_EQ(got("/v1/objects")["objects"].size(), 1u);
  EXPECT_EQ(tell({{"event", "dropped"}, {"object", "my mug"}})["repeated"], 1) << "sent again";
  tell({{"event", "undone"}, {"number", dropped["number"]}});
  EXPECT_EQ(got("/v1/objects/cup-1")["alias"], "my mug");
  const std::string before = belief(port());
  daemon_->end(SIGKILL);
  start();
  EXPECT_EQ(belief(port()), before);
}

}  // namespace
}  // namespace anchord
