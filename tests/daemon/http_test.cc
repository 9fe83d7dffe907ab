// The program over HTTP.

#include <csignal>

#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

using Json = nlohmann::json;

/// POST /v1/detections with any header fields.
std::string post_as(const std::string& fields, const std::string& body) {
  return "POST /v1/detections HTTP/1.1\r\nHost: localhost\r\n" + fields +
         "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

class HttpTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(daemon_.ready()); }
  std::uint16_t port() const { return daemon_.port(); }
  Answer send(const std::string& body) { return ask(port(), post("/v1/detections", body)); }

  TestFolder folder_;
  DaemonProcess daemon_{folder_};
};

TEST_F(HttpTest, FramesInAnswersOut) {
  for (int i = 1; i <= 10; ++i) {
    const Answer answer = send(json(frame_number(i)));
    ASSERT_EQ(answer.status, 200) << answer.body;
    EXPECT_EQ(answer.body, "{\"accepted\":1}\n");
  }
  const auto array = "[" + json(frame_number(11)) + "," + json(frame_number(12)) + "]";
  EXPECT_EQ(send(array).body, "{\"accepted\":2}\n");
  EXPECT_EQ(Json::parse(send(array).body), Json({{"accepted", 0}, {"repeated", 2}}));
  EXPECT_EQ(send("[]").body, "{\"accepted\":0}\n");

  const auto objects = Json::parse(body(port(), "/v1/objects"));
  EXPECT_EQ(objects["utime"], frame_number(12).utime);
  ASSERT_EQ(objects["objects"].size(), 2u) << objects;
  const auto cup = Json::parse(body(port(), "/v1/objects/cup-1"));
  EXPECT_NEAR(cup["position"][0].get<double>(), 2, 0.1) << "where frame_number() has it";
  const auto where = Json::parse(body(port(), "/v1/where?class=cup&color=red"));
  EXPECT_EQ(where["answers"][0]["object"], "cup-1");
  EXPECT_EQ(where["answers"][0]["places"][0]["place"], "kitchen");
  EXPECT_NEAR(Json::parse(body(port(), "/v1/count"))["expected"].get<double>(), 2, 0.1);
  EXPECT_TRUE(Json::parse(body(port(), "/v1/hypotheses")).contains("utime"));
  EXPECT_EQ(belief(port()), belief(port())) << "the same bytes while no frame comes";
}

TEST_F(HttpTest, TellsOfItself) {
  ASSERT_EQ(send(json(frame_number(1))).status, 200);
  ASSERT_EQ(send(json(frame_number(1))).status, 200);
  const auto status = Json::parse(body(port(), "/v1/status"));
  EXPECT_EQ(status["ready"], true);
  EXPECT_EQ(status["utime"], frame_number(1).utime);
  EXPECT_EQ(status["frames"]["accepted"], 1);
  EXPECT_EQ(status["frames"]["repeated"], 1);
  EXPECT_EQ(status["log"]["frames"], 1);
  EXPECT_GT(status["log"]["bytes"], 0);
  EXPECT_EQ(status["http"]["address"], "127.0.0.1:" + std::to_string(port()));
  const Answer metrics = ask(port(), get("/metrics"));
  EXPECT_TRUE(metrics.has("text/plain; version=0.0.4"));
  EXPECT_NE(metrics.body.find("\nanchord_frames_accepted_total 1\n"), std::string::npos);
  EXPECT_NE(metrics.body.find("\nanchord_ready 1\n"), std::string::npos);

  const auto configuration = Json::parse(body(port(), "/v1/configuration"));
  EXPECT_EQ(configuration, Json::parse(kScene));
  EXPECT_EQ(ask(port(), get("/v1/configuration?at=now")).status, 400);

  const auto api = Json::parse(body(port(), "/v1/openapi.json"));
  for (const char* path : {"/v1/detections", "/v1/objects", "/v1/objects/{id}", "/v1/where",
                           "/v1/count", "/v1/hypotheses", "/v1/status", "/metrics"})
    EXPECT_TRUE(api["paths"].contains(path)) << path;
}

TEST_F(HttpTest, WrongCallsAreToldWhatWouldBeRight) {
  const std::string frame = json(frame_number(1));
  const struct {
    std::string request;
    int status;
    std::string in_body;
  } cases[] = {
      {get("/v1/detections"), 405, "POST"},
      {post("/v1/objects", frame), 405, "GET"},
      {get("/v1/nothing"), 404, "/v1/nothing"},
      {get("/v1/objects/cup-7"), 404, "cup-7"},
      {get("/v1/where?object=cup-7"), 404, "cup-7"},
      {get("/v1/where"), 400, "class=cup"},
      {get("/v1/objects?class=mug"), 400, "mug"},
      {get("/v1/objects?place=garage"), 400, "garage"},
      {get("/v1/objects?colour=red"), 400, "colour"},
      {get("/v1/objects?min_p=2"), 400, "min_p"},
      {post_as("", frame), 415, "Content-Type"},
      {post_as("Content-Type: text/plain\r\n", frame), 415, "application/json"},
      {post_as("Content-Type: application/jsonp\r\n", frame), 415, "application/json"},
      {post_as("Content-Type: application/json\r\nContent-Encoding: gzip\r\n", frame), 415,
       "compress"},
  };
  for (const auto& [request, status, in_body] : cases) {
    const Answer answer = ask(port(), request);
    EXPECT_EQ(answer.status, status) << request;
    EXPECT_NE(answer.body.find(in_body), std::string::npos) << request << answer.body;
    EXPECT_TRUE(Json::parse(answer.body)["error"].contains("code"));
  }
  EXPECT_EQ(counter(port(), "/http/client_errors"), 14);
  EXPECT_EQ(counter(port(), "/frames/accepted"), 0);
}

TEST_F(HttpTest, AContentTypeMayHaveParametersAndAnyCase) {
  int number = 0;
  for (const char* type :
       {"application/json; charset=utf-8", "Application/JSON", "application/json ;charset=UTF-8"}) {
    const auto request =
        post_as(std::string("Content-Type: ") + type + "\r\n", json(frame_number(++number)));
    EXPECT_EQ(ask(port(), request).status, 200) << type;
  }
}

}  // namespace
}  // namespace anchord
