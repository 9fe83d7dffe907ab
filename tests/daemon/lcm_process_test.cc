// The process that receives LCM: what kills it, what fills it, and that the daemon lives on.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <anchord/query_t.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "api/lcm_sender.h"
#include "daemon/lcm_receiver.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // memory has other limits then, and is written out of bounds
#else                              // with other signs
constexpr bool kSanitized = false;
#endif

/// The one child of a process; 0 while it has none.
pid_t child_of(pid_t parent) {
  pid_t child = 0;
  const std::string tasks = "/proc/" + std::to_string(parent) + "/task";
  std::error_code gone;
  for (const auto& task : std::filesystem::directory_iterator(tasks, gone))
    std::ifstream(task.path() / "children") >> child;
  return child;
}

/// A line of /proc/PID/status: kB, or the first letter of a word.
std::string proc_status(pid_t pid, const std::string& name) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/status");
  std::string word, value;
  while (file >> word)
    if (word == name + ":" && file >> value) return value;
  return "";
}

bool runs(pid_t pid) {
  const std::string state = proc_status(pid, "State");
  return !state.empty() && state != "Z" && state != "X";
}

long megabytes(pid_t pid, const std::string& name) {
  const std::string kb = proc_status(pid, name);
  return kb.empty() ? 0 : std::stol(kb) / 1024;
}

std::int64_t restarts(const DaemonProcess& daemon) {
  return counter(daemon.port(), "/lcm/restarts");
}

bool receiving(const DaemonProcess& daemon) {
  return body(daemon.port(), "/v1/status").find("\"receiving\":true") != std::string::npos;
}

// --- Without a network ---------------------------------------------------------------------------

TEST(LcmProcess, IsStartedAgainAndHasNothingOfTheDaemons) {
  TestFolder folder;
  DaemonProcess daemon(folder);
  ASSERT_TRUE(daemon.ready());
  const std::string before = belief(daemon.port());
  for (int deaths = 1; deaths <= 3; ++deaths) {
    const pid_t child = child_of(daemon.pid());
    ASSERT_NE(child, 0);
    kill(child, SIGKILL);
    ASSERT_TRUE(eventually([&] { return restarts(daemon) == deaths && receiving(daemon); }));
  }
  EXPECT_EQ(belief(daemon.port()), before);
  EXPECT_NE(daemon.errors().find("has died (signal 9)"), std::string::npos) << daemon.errors();

  const pid_t child = child_of(daemon.pid());
  std::error_code forbidden;
  for (const auto& file :
       std::filesystem::directory_iterator("/proc/" + std::to_string(child) + "/fd", forbidden)) {
    const auto open = std::filesystem::read_symlink(file.path()).string();
    EXPECT_EQ(open.find(folder / "data"), std::string::npos) << open;
  }
  EXPECT_EQ(proc_status(child, "NoNewPrivs"), "1");
  kill(child, SIGTERM);  // as who ends the daemon's group does
  EXPECT_EQ(daemon.end(SIGTERM), 0);
  EXPECT_TRUE(eventually([&] { return !runs(child); }));
  EXPECT_EQ(daemon.errors().find("signal 15"), std::string::npos) << daemon.errors();
}

TEST(LcmProcess, EndsWithTheDaemonHoweverThatEnds) {
  TestFolder folder;
  DaemonProcess daemon(folder);
  ASSERT_TRUE(daemon.ready());
  const pid_t child = child_of(daemon.pid());
  ASSERT_TRUE(runs(child));
  EXPECT_EQ(daemon.end(SIGKILL), -SIGKILL);
  EXPECT_TRUE(eventually([&] { return !runs(child); }));
}

/// A program for LcmReceiver that does what `script` says, with the daemon at descriptor 3.
std::string program(const TestFolder& folder, const std::string& script) {
  const std::string path = folder.write("program", "#!/bin/sh\n" + script);
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

/// Records without bytes, of the kinds kJoined and kHears.
constexpr char kJoins[] = "printf '\\000\\000\\000\\000\\000\\000\\000\\000' >&3\n",
               kBegins[] = "head -c 1 <&3 >/dev/null\n",
               kHears[] = "printf '\\000\\000\\000\\000\\002\\000\\000\\000' >&3\n";

TEST(LcmReceiver, PausesLongerAndLongerWhereItDoesNotComeUp) {
  TestFolder folder;
  const std::string flag = folder / "flag";
  auto receiver =
      LcmReceiver::open(program(folder, "[ -e " + flag + " ] && exit 1\n" + kJoins + kBegins +
                                            "touch " + flag + "\n" + kHears + "exec sleep 0.1\n"),
                        "memq://");
  ASSERT_TRUE(receiver.ok()) << receiver.error().text();
  const auto& counters = (*receiver)->counters();
  EXPECT_FALSE(counters.receiving);
  const auto begin = Clock::now();
  (*receiver)->start([](const LcmRecord&) {});
  EXPECT_TRUE(std::filesystem::exists(flag)) << "it returns once the program says that it hears";
  ASSERT_TRUE(eventually([&] { return counters.restarts >= 5; }));
  // 100, 200, 400 and 800 ms lie between the second start and the sixth: no sleep is shorter than
  // it was asked to be.
  EXPECT_GE(Clock::now() - begin, std::chrono::milliseconds(1500));
  EXPECT_FALSE(counters.receiving);
  std::filesystem::remove(flag);
  EXPECT_TRUE(eventually([&] { return counters.receiving.load(); })) << "it is tried again";
}

TEST(LcmReceiver, WhatCannotBeStartedOrTellsNonsenseIsAnError) {
  TestFolder folder;
  const auto missing = LcmReceiver::open(folder / "none", "memq://");
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().message.find("none"), std::string::npos) << missing.error().text();
  const auto silent = LcmReceiver::open(program(folder, "exit 3"), "memq://");
  ASSERT_FALSE(silent.ok());
  EXPECT_NE(silent.error().message.find("status 3"), std::string::npos) << silent.error().text();
  const auto wild =
      LcmReceiver::open(program(folder, "printf 'nonsense' >&3; exec sleep 60"), "memq://");
  ASSERT_FALSE(wild.ok());
  EXPECT_NE(wild.error().message.find("nonsense"), std::string::npos) << wild.error().text();
}

// --- Over multicast on this machine, ttl 0 -------------------------------------------------------

class LcmProcessTest : public ::testing::Test {
 protected:
  void SetUp() override {
    // A port of its own keeps other networks, and other tests, out.
    port_ = static_cast<std::uint16_t>(20'000 + std::random_device()() % 20'000);
    const std::string url = "udpm://239.255.76.67:" + std::to_string(port_) + "?ttl=0";
    auto sender = LcmSender::open(url);
    if (!sender)
      GTEST_SKIP() << "\n*** NOT TESTED: a hostile LCM network. There is no multicast here; "
                      "`ip route add 224.0.0.0/4 dev lo` would give it. ***";
    sender_ = *std::move(sender);
    DaemonProcess::Options options;
    options.lcm = url;
    daemon_ = std::make_unique<DaemonProcess>(folder_, options);
    ASSERT_TRUE(daemon_->ready());
  }
  void TearDown() override {
    if (socket_ >= 0) close(socket_);
  }

  /// Sends a datagram as it is, from another port each time if `elsewhere`.
  void send_raw(const Bytes& datagram, bool elsewhere = false) {
    if (elsewhere && socket_ >= 0) close(std::exchange(socket_, -1));
    if (socket_ < 0) {
      socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
      const int ttl = 0;
      setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
    }
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port_);
    inet_aton("239.255.76.67", &to.sin_addr);
    sendto(socket_, datagram.data(), datagram.size(), 0, reinterpret_cast<sockaddr*>(&to),
           sizeof to);
  }

  /// The first fragment of a message on ANCHORD_DETECTIONS: LCM's header, channel, 32 bytes.
  static Bytes first_fragment(std::uint32_t message_size, std::uint32_t offset) {
    Bytes bytes;
    const auto put = [&](std::uint32_t value, int size) {
      for (int shift = 8 * (size - 1); shift >= 0; shift -= 8)
        bytes.push_back(static_cast<std::uint8_t>(value >> shift));
    };
    put(0x4c433033, 4);  // LC03
    put(1, 4);           // the message's number
    put(message_size, 4);
    put(offset, 4);
    put(0, 2);    // the fragment's number
    put(300, 2);  // of so many
    for (const char* c = kDetectionsChannel; *c; ++c)
      bytes.push_back(static_cast<std::uint8_t>(*c));
    bytes.resize(bytes.size() + 1 + 32);
    return bytes;
  }

  /// An unfragmented message without content.
  static Bytes short_message(const std::string& channel) {
    Bytes bytes = {'L', 'C', '0', '2', 0, 0, 0, 1};
    bytes.insert(bytes.end(), channel.begin(), channel.end());
    bytes.push_back(0);
    return bytes;
  }

  /// Sends a frame, again and again where it has been lost, until it is in the belief.
  void expect_heard(int number) {
    const std::int64_t before = counter(daemon_->port(), "/frames/accepted");
    EXPECT_TRUE(eventually([&] {
      EXPECT_TRUE(sender_->publish(kDetectionsChannel, encode(frame_number(number), 0)).ok());
      return counter(daemon_->port(), "/frames/accepted") > before;
    }));
  }

  /// Neither process has taken more memory than it may: the receiving one is limited to 128 MiB of
  /// data, beside its program; to the daemon's 64 MiB of what waits may be added.
  void expect_bounded(long daemon_before) {
    if (kSanitized) return;
    EXPECT_LT(megabytes(child_of(daemon_->pid()), "VmHWM"), 128 + 32);
    EXPECT_LT(megabytes(daemon_->pid(), "VmHWM"), daemon_before + 64);
  }
  long daemon_memory() { return megabytes(daemon_->pid(), "VmRSS"); }

  TestFolder folder_;
  std::uint16_t port_ = 0;
  int socket_ = -1;
  std::unique_ptr<LcmSender> sender_;
  std::unique_ptr<DaemonProcess> daemon_;
};

TEST_F(LcmProcessTest, AFragmentThatKillsLiblcmDoesNotReachTheBelief) {
  for (int i = 1; i <= 3; ++i) expect_heard(i);
  for (int deaths = 1; deaths <= 3; ++deaths) {
    const std::string before = belief(daemon_->port());
    const pid_t child = child_of(daemon_->pid());
    // liblcm 1.3.1 adds the offset and the fragment's size in 32 bits, finds that small, and writes
    // 4 GiB behind the message's memory.
    send_raw(first_fragment(1024, 0xfffffff0));
    const auto sent = Clock::now();
    ASSERT_TRUE(eventually([&] { return child_of(daemon_->pid()) != child; }));
    ASSERT_TRUE(eventually([&] { return restarts(*daemon_) == deaths && receiving(*daemon_); }));
    std::printf("received again %.0f ms after the fragment\n",
                std::chrono::duration<double, std::milli>(Clock::now() - sent).count());
    EXPECT_EQ(belief(daemon_->port()), before);
    expect_heard(3 + deaths);
  }
  EXPECT_NE(daemon_->errors().find(kSanitized ? "has died" : "has died (signal 11)"),
            std::string::npos)
      << daemon_->errors();
  EXPECT_EQ(counter(daemon_->port(), "/frames/accepted"), 6);
  EXPECT_EQ(daemon_->end(SIGTERM), 0);
}

TEST_F(LcmProcessTest, FragmentFloods) {
  expect_heard(1);
  const long before = daemon_memory();
  // Messages of 15 MB, and then of 250 MB, that never become whole, each from elsewhere.
  for (int i = 0; i < 3000; ++i) send_raw(first_fragment(15u << 20, 0), true);
  expect_heard(2);
  expect_bounded(before);
  for (int i = 0; i < 300; ++i) send_raw(first_fragment(250u << 20, 0), true);
  expect_heard(3);
  expect_bounded(before);
}

TEST_F(LcmProcessTest, AMillionChannels) {
  if (kSanitized) GTEST_SKIP() << "the process that receives has no limit of memory";
  expect_heard(1);
  const long before = daemon_memory();
  const std::string tail(50, 'x');
  constexpr int kMost = 5'000'000;  // where many get lost on the way
  int sent = 0;
  long most = 0;
  while (sent < kMost && (sent < 1'000'000 || restarts(*daemon_) == 0)) {
    for (int i = 0; i < 10'000; ++i) send_raw(short_message(std::to_string(++sent) + tail));
    most = std::max(most, megabytes(child_of(daemon_->pid()), "VmHWM"));
    expect_bounded(before);
  }
  std::printf("%d names, at most %ld MB, %lld restarts\n", sent, most,
              static_cast<long long>(restarts(*daemon_)));
  EXPECT_GT(restarts(*daemon_), 0) << "liblcm forgets no name: memory's limit ends it";
  expect_heard(2);
}

/// Sends `count` questions of 8 kB, at a pace at which none is lost on the way to a process that
/// listens.
void ask_much(LcmSender& sender, int count) {
  query_t query{};
  query.target = "/v1/" + std::string(8000, 'x');
  const Bytes bytes = encode_message(query);
  for (int i = 0; i < count; ++i) {
    ASSERT_TRUE(sender.publish(kQueryChannel, bytes).ok());
    if (i % 50 == 49) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST_F(LcmProcessTest, WhatTheDaemonDoesNotReadIsDroppedAndCounted) {
  expect_heard(1);
  const pid_t child = child_of(daemon_->pid());
  kill(daemon_->pid(), SIGSTOP);
  ask_much(*sender_, 6000);  // 48 MB; twice 16 MiB may wait, and what the socket holds
  kill(daemon_->pid(), SIGCONT);
  EXPECT_TRUE(eventually([&] { return counter(daemon_->port(), "/lcm/dropped") > 0; }));
  expect_heard(2);
  EXPECT_EQ(child_of(daemon_->pid()), child) << "it lives on";
  EXPECT_EQ(counter(daemon_->port(), "/lcm/restarts"), 0);
}

TEST_F(LcmProcessTest, WhatTheKernelDropsIsCounted) {
  expect_heard(1);
  const pid_t child = child_of(daemon_->pid());
  EXPECT_EQ(counter(daemon_->port(), "/lcm/dropped_by_kernel"), 0);
  kill(child, SIGSTOP);
  ask_much(*sender_, 4000);  // 32 MB; no receive buffer is larger than 8 MiB, which Linux doubles
  kill(child, SIGCONT);
  EXPECT_TRUE(eventually([&] { return counter(daemon_->port(), "/lcm/dropped_by_kernel") > 0; }));
  expect_heard(2);
}

TEST_F(LcmProcessTest, OneFrameAgainAndAgain) {
  expect_heard(1);
  const long before = daemon_memory();
  const Bytes same = encode(frame_number(1), 0);
  for (int i = 0; i < 20'000; ++i) ASSERT_TRUE(sender_->publish(kDetectionsChannel, same).ok());
  expect_heard(2);
  expect_bounded(before);
  EXPECT_EQ(counter(daemon_->port(), "/frames/accepted"), 2);
  EXPECT_EQ(counter(daemon_->port(), "/log/frames"), 2);
  EXPECT_GT(counter(daemon_->port(), "/frames/repeated"), 0);
}

}  // namespace
}  // namespace anchord
