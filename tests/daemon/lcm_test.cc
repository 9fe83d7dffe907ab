// The program over LCM for real: multicast on this machine, ttl 0.

#include <anchord/answer_t.hpp>
#include <anchord/query_t.hpp>
#include <anchord/rejected_t.hpp>
#include <anchord/world_t.hpp>
#include <csignal>
#include <map>
#include <mutex>
#include <random>

#include "api/lcm_bus.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// What the daemon publishes, decoded.
class LcmTest : public ::testing::Test {
 protected:
  void SetUp() override {
    // A port of its own keeps other networks, and other tests, out.
    std::random_device any;
    url_ = "udpm://239.255.76.67:" + std::to_string(20'000 + any() % 20'000) + "?ttl=0";
    auto bus = LcmBus::open(url_);
    if (!bus)
      GTEST_SKIP() << "\n*** NOT TESTED: the daemon over real multicast. There is no multicast "
                      "here; `ip route add 224.0.0.0/4 dev lo` would give it. ***";
    bus_ = *std::move(bus);
    listen<world_t>(kWorldChannel, worlds_);
    listen<answer_t>(kAnswerChannel, answers_);
    listen<rejected_t>(kRejectedChannel, rejections_);
    bus_->start();
    DaemonProcess::Options options;
    options.lcm = url_;
    daemon_ = std::make_unique<DaemonProcess>(folder_, options);
    ASSERT_TRUE(daemon_->ready());
  }
  void TearDown() override {
    if (bus_) bus_->stop();
  }

  template <typename Message>
  void listen(const char* channel, std::vector<Message>& into) {
    ASSERT_TRUE(bus_->subscribe(channel,
                                [this, &into](std::span<const std::uint8_t> bytes) {
                                  Message message{};
                                  const int size = static_cast<int>(bytes.size());
                                  const int read = message.decode(bytes.data(), 0, size);
                                  std::lock_guard lock(mutex_);
                                  EXPECT_EQ(read, size);
                                  into.push_back(std::move(message));
                                })
                    .ok());
  }
  /// The messages so far once there are `count`; fewer if they do not come.
  template <typename Message>
  std::vector<Message> received(const std::vector<Message>& from, std::size_t count) {
    const auto all = [&] {
      std::lock_guard lock(mutex_);
      return from;
    };
    EXPECT_TRUE(eventually([&] { return all().size() >= count; }));
    return all();
  }
  void publish(const char* channel, const Bytes& bytes) {
    ASSERT_TRUE(bus_->publish(channel, bytes).ok());
  }
  void publish_frame(int number, std::int64_t seq) {
    publish(kDetectionsChannel, encode(frame_number(number), seq));
  }
  std::int64_t counter_of(const std::string& pointer) { return counter(daemon_->port(), pointer); }

  TestFolder folder_;
  std::string url_;
  std::unique_ptr<LcmBus> bus_;
  std::unique_ptr<DaemonProcess> daemon_;
  std::mutex mutex_;
  std::vector<world_t> worlds_;  // guarded by mutex_, as the others
  std::vector<answer_t> answers_;
  std::vector<rejected_t> rejections_;
};

TEST_F(LcmTest, FramesInWorldsOut) {
  for (int i = 1; i <= 20; ++i) {
    publish_frame(i, i);
    ASSERT_EQ(received(worlds_, static_cast<std::size_t>(i)).size(), static_cast<std::size_t>(i));
  }
  const auto worlds = received(worlds_, 20);
  for (int i = 1; i <= 20; ++i) {
    EXPECT_EQ(worlds[static_cast<std::size_t>(i - 1)].seq, i);
    EXPECT_EQ(worlds[static_cast<std::size_t>(i - 1)].utime, frame_number(i).utime);
  }
  ASSERT_EQ(worlds.back().num_objects, 2);
  std::map<std::string, object_t> objects;
  for (const auto& object : worlds.back().objects) objects[object.id] = object;
  ASSERT_TRUE(objects.contains("cup-1"));
  EXPECT_NEAR(objects["cup-1"].position[0], 2, 0.1) << "where frame_number() has it";
  EXPECT_EQ(objects["cup-1"].place, "kitchen");
  EXPECT_EQ(objects["cup-1"].symbol_class, "cup");

  // Nobody waits for it, and it is made durable all the same.
  EXPECT_TRUE(eventually([&] { return counter_of("/frames/accepted") == 20; }));
  EXPECT_EQ(counter_of("/lcm/frames"), 20);
  EXPECT_EQ(counter_of("/frames/lost"), 0);
  const std::string before = belief(daemon_->port());
  EXPECT_EQ(daemon_->end(SIGKILL), -SIGKILL);
  DaemonProcess again(folder_);
  ASSERT_TRUE(again.ready());
  EXPECT_EQ(belief(again.port()), before);
}

TEST_F(LcmTest, GapsAndRepetitionsAreCounted) {
  publish_frame(1, 1);
  publish_frame(2, 5);
  publish_frame(2, 6);
  EXPECT_TRUE(eventually([&] { return counter_of("/frames/repeated") == 1; }));
  EXPECT_EQ(counter_of("/frames/lost"), 3);
  EXPECT_EQ(counter_of("/frames/accepted"), 2);
  EXPECT_EQ(counter_of("/frames/refused"), 0);
}

TEST_F(LcmTest, QuestionsGetWhatHttpAnswers) {
  publish_frame(1, 1);
  received(worlds_, 1);
  query_t query{};
  for (const char* target : {"/v1/objects?min_p=0", "/v1/where?class=cup", "/v1/objects/none",
                             "/v1/where?class=mug", "no target"}) {
    ++query.id;
    query.target = target;
    publish(kQueryChannel, encode_message(query));
    const auto answers = received(answers_, static_cast<std::size_t>(query.id));
    ASSERT_EQ(answers.size(), static_cast<std::size_t>(query.id)) << target;
    EXPECT_EQ(answers.back().id, query.id);
    if (query.id == 5) {
      EXPECT_EQ(answers.back().status, 400);
      break;
    }
    const Answer over_http = ask(daemon_->port(), get(target));
    EXPECT_EQ(answers.back().status, over_http.status);
    EXPECT_EQ(answers.back().json, over_http.body);
  }
}

TEST_F(LcmTest, BrokenMessagesAreRefusedAndChangeNothing) {
  publish_frame(1, 1);
  ASSERT_TRUE(eventually([&] { return counter_of("/frames/accepted") == 1; }));
  const std::string before = belief(daemon_->port());
  const Bytes good = encode(frame_number(2), 2);
  std::vector<Bytes> broken = {{}, {1, 2, 3}, Bytes(good.begin(), good.end() - 1), good, good};
  broken[3].push_back(0);  // trailing
  broken[4][0] ^= 0x80;    // of another type
  for (const std::size_t half : {good.size() / 3, good.size() / 2, good.size() - 9})
    broken.emplace_back(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(half));
  Bytes lying = encode(Frame{frame_number(2).utime, "", "kinect", {}, {}, {}}, 2);
  lying[lying.size() - 4] = 0xff;  // the count of detections: -16777216
  broken.push_back(lying);
  lying[lying.size() - 4] = 0x7f;  // 2130706432
  broken.push_back(lying);
  Frame wrong = frame_number(2);
  std::get<CartesianMeasurement>(wrong.detections[0].measurement).covariance[0] =
      std::numeric_limits<double>::quiet_NaN();
  broken.push_back(encode(wrong, 2));

  std::size_t count = 0;
  for (const Bytes& bytes : broken) {
    publish(kDetectionsChannel, bytes);
    const auto rejections = received(rejections_, ++count);
    ASSERT_EQ(rejections.size(), count);
    EXPECT_EQ(rejections.back().channel, kDetectionsChannel);
    EXPECT_FALSE(rejections.back().reason.empty());
    EXPECT_GT(rejections.back().utime, kStart);
  }
  const auto last = received(rejections_, count).back();
  EXPECT_EQ(last.field, "detections[0].covariance");
  EXPECT_EQ(last.sensor, "kinect");
  EXPECT_EQ(last.frame_utime, wrong.utime);
  EXPECT_EQ(counter_of("/frames/refused"), static_cast<std::int64_t>(count)) << "each once";
  EXPECT_EQ(counter_of("/lcm/refused"), static_cast<std::int64_t>(count));

  publish(kQueryChannel, {1, 2, 3});
  EXPECT_EQ(received(rejections_, ++count).back().channel, kQueryChannel);
  EXPECT_EQ(counter_of("/lcm/refused"), static_cast<std::int64_t>(count));

  // What is refused over HTTP is told there too.
  EXPECT_EQ(ask(daemon_->port(), post("/v1/detections", "{}")).status, 400);
  EXPECT_EQ(received(rejections_, ++count).back().channel, "HTTP");
  EXPECT_EQ(belief(daemon_->port()), before);
}

TEST_F(LcmTest, FlippedBitsNeverStopIt) {
  const Bytes good = encode(frame_number(1), 0);
  std::mt19937 dice(7);
  constexpr int kMessages = 400;
  for (int i = 0; i < kMessages; ++i) {
    Bytes bytes = good;
    for (int flips = 0; flips < 3; ++flips)
      bytes[dice() % bytes.size()] ^= static_cast<std::uint8_t>(1u << dice() % 8);
    publish(kDetectionsChannel, bytes);
    // Not more at once than the kernel's buffer holds.
    if (i % 20 == 19) {
      ASSERT_TRUE(eventually([&] { return counter_of("/lcm/frames") == i + 1; }));
    }
  }
  EXPECT_TRUE(eventually([&] {
    return counter_of("/frames/refused") + counter_of("/frames/accepted") +
               counter_of("/frames/repeated") ==
           kMessages;
  }));
  EXPECT_GT(counter_of("/frames/refused"), 0);
  EXPECT_EQ(daemon_->end(SIGTERM), 0);
}

}  // namespace
}  // namespace anchord
