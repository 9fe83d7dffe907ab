// Questions about the past and about the log, asked of the daemon itself over HTTP.

#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/daemon/daemon_process.h"
#include "tests/daemon/load.h"

namespace anchord {
namespace {

using nlohmann::json;

/// A cup that lies in the kitchen, is out of it from frame 20 on, and comes back with frame 40;
/// frames 1 s apart.
Frame moving_cup(int second) {
  Frame frame = frame_number(second);
  frame.utime = kStart + second * Utime{1'000'000};
  const bool away = second >= 20 && second < 40;
  std::get<CartesianMeasurement>(frame.detections[0].measurement).position = {away ? 8.0 : 2.0, 3,
                                                                              0.9};
  frame.detections.resize(1);
  return frame;
}

class ArchiveTest : public ::testing::Test {
 protected:
  void SetUp() override {
    daemon_ = std::make_unique<DaemonProcess>(folder_);
    ASSERT_TRUE(daemon_->ready());
    client_ = std::make_unique<Client>(daemon_->port());
    for (int second = 1; second <= 60; ++second) {
      ASSERT_EQ(client_->ask(post("/v1/detections", anchord::json(moving_cup(second)))).status,
                200);
      if (second % 10 == 5) asked_[second] = body("/v1/where?class=cup");
    }
  }
  std::string body(const std::string& target, unsigned status = 200) {
    const auto response = client_->ask(get(target));
    EXPECT_EQ(response.status, status) << target << "\n" << response.body;
    return response.body;
  }
  static std::string utime(int second) { return std::to_string(moving_cup(second).utime); }

  TestFolder folder_;
  std::unique_ptr<DaemonProcess> daemon_;
  std::unique_ptr<Client> client_;
  std::map<int, std::string> asked_;  ///< by second, when it was the newest
};

TEST_F(ArchiveTest, AtAnswersAsItWasAnsweredThen) {
  for (const auto& [second, answer] : asked_) {
    EXPECT_EQ(body("/v1/where?class=cup&at=" + utime(second)), answer);
    EXPECT_EQ(body("/v1/where?at=" + utime(second) + "1000&class=cup", 400).find("\"at\"") ==
                  std::string::npos,
              false);
  }
  daemon_->end(SIGKILL);
  daemon_ = std::make_unique<DaemonProcess>(folder_);
  ASSERT_TRUE(daemon_->ready());
  client_ = std::make_unique<Client>(daemon_->port());
  for (const auto& [second, answer] : asked_)
    EXPECT_EQ(body("/v1/where?class=cup&at=" + utime(second)), answer);
}

TEST_F(ArchiveTest, TheFutureIsPredicted) {
  const auto now = json::parse(body("/v1/objects"));
  const auto soon = json::parse(body("/v1/objects?at=" + utime(600)));
  EXPECT_EQ(soon["utime"], moving_cup(600).utime);
  EXPECT_EQ(now["utime"], moving_cup(60).utime);
  EXPECT_GT(soon["objects"][0]["covariance"][0].get<double>(),
            now["objects"][0]["covariance"][0].get<double>());
  const auto clock = json::parse(body("/v1/count?class=cup&at=now"));
  EXPECT_GT(clock["utime"].get<Utime>(), moving_cup(600).utime);
}

TEST_F(ArchiveTest, RefusesWhatIsNoTime) {
  for (const char* at : {"yesterday", "", "1.5", "17", "-5", "99999999999999999999"})
    EXPECT_NE(body(std::string("/v1/objects?at=") + at, 400).find("\"field\":\"at\""),
              std::string::npos)
        << at;
  body("/v1/objects?at=now&at=now", 400);
}

TEST_F(ArchiveTest, AHistorySaysWhenItWasWhere) {
  const auto history = json::parse(body("/v1/history?object=cup-1"));
  std::vector<std::pair<int, json>> places;  // where it came into another one
  for (const auto& sample : history["samples"]) {
    const int second = static_cast<int>((sample["utime"].get<Utime>() - kStart) / 1'000'000);
    if (places.empty() || places.back().second != sample["place"])
      places.emplace_back(second, sample["place"]);
    EXPECT_LE(sample["p"].get<double>(), 1);
    EXPECT_GT(sample["spread"].get<double>(), 0);
  }
  ASSERT_GE(places.size(), 1u) << history;
  EXPECT_EQ(places.front().second, "kitchen");
  EXPECT_EQ(history["samples"].back()["utime"], moving_cup(60).utime) << "what is now is in it";
  // Each is what was believed then.
  for (std::size_t i = 0; i < history["samples"].size(); i += 3) {
    const auto& sample = history["samples"][i];
    const auto then = json::parse(
        body("/v1/where?object=cup-1&at=" + std::to_string(sample["utime"].get<Utime>())));
    EXPECT_EQ(then["answers"][0]["p"], sample["p"]);
    EXPECT_EQ(then["answers"][0]["position"], sample["position"]);
  }
  const auto part =
      json::parse(body("/v1/history?object=cup-1&from=" + utime(10) + "&to=" + utime(50)));
  for (const auto& sample : part["samples"]) {
    EXPECT_GE(sample["utime"].get<Utime>(), moving_cup(10).utime);
    EXPECT_LE(sample["utime"].get<Utime>(), moving_cup(50).utime);
  }
  body("/v1/history", 400);
  body("/v1/history?object=cup-99", 404);
  body("/v1/history?object=cup-1&from=" + utime(9) + "&to=" + utime(8), 400);
  body("/v1/history?object=cup-1&colour=red", 400);
}

TEST_F(ArchiveTest, AnObjectSaysByWhomItWasSeen) {
  const auto seen = json::parse(body("/v1/objects/cup-1"))["seen"];
  EXPECT_EQ(seen["utime"], moving_cup(60).utime);
  EXPECT_EQ(seen["sensor"], "kinect");
  EXPECT_EQ(seen["robot"], "");
  EXPECT_EQ(seen["frame"], 60);
  EXPECT_EQ(seen["detection"], 0);
  const auto then = json::parse(body("/v1/objects/cup-1?at=" + utime(15)))["seen"];
  EXPECT_EQ(then["frame"], 15);
}

}  // namespace
}  // namespace anchord
