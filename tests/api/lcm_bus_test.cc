#include "api/lcm_bus.h"

#include <gtest/gtest.h>
#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <vector>

namespace anchord {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Messages that came in, and a wait for them.
class Inbox {
 public:
  LcmBus::Handler handler() {
    return [this](std::span<const std::uint8_t> bytes) {
      const std::lock_guard lock(mutex_);
      messages_.emplace_back(bytes.begin(), bytes.end());
      arrived_.notify_all();
    };
  }
  /// The first `count` messages; fewer if they do not come. The deadline only ends a failing test.
  std::vector<Bytes> wait_for(std::size_t count) {
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, std::chrono::seconds(20), [&] { return messages_.size() >= count; });
    return messages_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<Bytes> messages_;
};

Bytes numbered(std::size_t size, std::uint8_t number) { return Bytes(size, number); }

TEST(LcmBus, DeliversWithinAProcess) {
  auto bus = LcmBus::open("memq://");
  ASSERT_TRUE(bus.ok()) << bus.error().text();
  Inbox inbox, other;
  ASSERT_TRUE((*bus)->subscribe("A", inbox.handler()).ok());
  ASSERT_TRUE((*bus)->subscribe("B", other.handler()).ok());
  (*bus)->start();
  for (std::uint8_t i = 0; i < 100; ++i) {
    ASSERT_TRUE((*bus)->publish("A", numbered(10, i)).ok());
  }
  const std::vector<Bytes> messages = inbox.wait_for(100);
  ASSERT_EQ(messages.size(), 100u);
  for (std::uint8_t i = 0; i < 100; ++i) EXPECT_EQ(messages[i], numbered(10, i));
  (*bus)->stop();
  EXPECT_TRUE(other.wait_for(0).empty());
}

TEST(LcmBus, AHandlerMayPublishAndThrow) {
  auto bus = LcmBus::open("memq://");
  ASSERT_TRUE(bus.ok()) << bus.error().text();
  Inbox answers;
  ASSERT_TRUE((*bus)
                  ->subscribe("QUESTION",
                              [&](std::span<const std::uint8_t> bytes) {
                                EXPECT_TRUE((*bus)->publish("ANSWER", bytes).ok());
                                throw std::runtime_error("thrown by the test");
                              })
                  .ok());
  ASSERT_TRUE((*bus)->subscribe("ANSWER", answers.handler()).ok());
  (*bus)->start();
  ASSERT_TRUE((*bus)->publish("QUESTION", numbered(3, 1)).ok());
  ASSERT_TRUE((*bus)->publish("QUESTION", numbered(3, 2)).ok());
  EXPECT_EQ(answers.wait_for(2), (std::vector<Bytes>{numbered(3, 1), numbered(3, 2)}));
}

TEST(LcmBus, ManyThreadsMayPublish) {
  auto bus = LcmBus::open("memq://");
  ASSERT_TRUE(bus.ok()) << bus.error().text();
  Inbox inbox;
  ASSERT_TRUE((*bus)->subscribe("A", inbox.handler()).ok());
  (*bus)->start();
  std::vector<std::thread> threads;
  for (std::uint8_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 100; ++i) EXPECT_TRUE((*bus)->publish("A", numbered(4, t)).ok());
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(inbox.wait_for(400).size(), 400u);
}

TEST(LcmBus, StopsWheneverAsked) {
  for (int i = 0; i < 20; ++i) {
    auto bus = LcmBus::open("memq://");
    ASSERT_TRUE(bus.ok());
    if (i % 2) (*bus)->start();
    (*bus)->stop();
    (*bus)->stop();
  }
}

TEST(LcmBus, RefusesWhatIsNoUrl) {
  for (const char* url : {"nowhere://", "udpm", "udpm://not-an-address:7667"}) {
    const auto bus = LcmBus::open(url);
    ASSERT_FALSE(bus.ok()) << url;
    EXPECT_EQ(bus.error().code,
              std::string(url).starts_with("udpm://") ? ErrorCode::kIo : ErrorCode::kInvalid);
    EXPECT_NE(bus.error().message.find(url), std::string::npos);
  }
}

TEST(LcmBus, ChoosesTheUrl) {
  unsetenv("LCM_DEFAULT_URL");
  const std::string plain = "udpm://239.255.76.67:7667?ttl=0";
  EXPECT_EQ(effective_lcm_url("").find(plain + "&recv_buf_size="), 0u);
  EXPECT_EQ(effective_lcm_url("udpm://").find("udpm://?recv_buf_size="), 0u);
  const std::string sized = "udpm://239.255.76.67:7667?recv_buf_size=1000&ttl=1";
  EXPECT_EQ(effective_lcm_url(sized), sized);
  EXPECT_EQ(effective_lcm_url("memq://"), "memq://");
  setenv("LCM_DEFAULT_URL", "memq://", 1);
  EXPECT_EQ(effective_lcm_url(""), "memq://");
  unsetenv("LCM_DEFAULT_URL");
}

// --- Real multicast -----------------------------------------------------------------------------

constexpr int kForbidden = 77;

/// What `body` returns in a child process with a network of its own that holds only a loopback
/// device, with a multicast route if `routed`; kForbidden where the kernel does not allow that.
int in_own_network(bool routed, const std::function<int()>& body) {
  const pid_t child = fork();
  if (child == 0) {
    if (unshare(CLONE_NEWNET) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) _exit(kForbidden);
    const int control = socket(AF_INET, SOCK_DGRAM, 0);
    ifreq loopback{};
    std::strcpy(loopback.ifr_name, "lo");
    loopback.ifr_flags = IFF_UP | IFF_RUNNING | IFF_LOOPBACK | IFF_MULTICAST;
    if (ioctl(control, SIOCSIFFLAGS, &loopback) != 0) _exit(kForbidden);
    if (routed) {
      char device[] = "lo";
      rtentry route{};
      auto* to = reinterpret_cast<sockaddr_in*>(&route.rt_dst);
      auto* mask = reinterpret_cast<sockaddr_in*>(&route.rt_genmask);
      to->sin_family = mask->sin_family = AF_INET;
      to->sin_addr.s_addr = htonl(0xe0000000);  // 224.0.0.0/4: all of multicast
      mask->sin_addr.s_addr = htonl(0xf0000000);
      route.rt_flags = RTF_UP;
      route.rt_dev = device;
      if (ioctl(control, SIOCADDRT, &route) != 0) _exit(kForbidden);
    }
    close(control);
    _exit(body());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Sends small and large messages from one bus to another; 0 if they all come, in order.
int exchange() {
  auto sender = LcmBus::open(""), receiver = LcmBus::open("");
  if (!sender || !receiver) return 2;
  Inbox inbox;
  if (!(*receiver)->subscribe("ANCHORD_BUS_TEST", inbox.handler())) return 3;
  (*receiver)->start();
  std::vector<Bytes> sent;
  for (std::uint8_t i = 0; i < 20; ++i) {
    sent.push_back(numbered(i % 5 == 4 ? 200'000 : 100, i));  // 200 kB: several datagrams
    if (!(*sender)->publish("ANCHORD_BUS_TEST", sent.back())) return 4;
    if (inbox.wait_for(sent.size()).size() != sent.size()) return 5;
  }
  return inbox.wait_for(sent.size()) == sent ? 0 : 6;
}

TEST(LcmBusMulticast, DeliversBetweenBuses) {
  unsetenv("LCM_DEFAULT_URL");
  const int outcome = in_own_network(true, exchange);
  if (outcome != kForbidden) {
    EXPECT_EQ(outcome, 0) << "in a network of its own; see exchange() for the number";
    return;
  }
  if (!LcmBus::open("")) {
    GTEST_SKIP()
        << "\n*** NOT TESTED: LCM over real multicast. The kernel allows neither a network "
           "namespace\n*** nor multicast here; `ip route add 224.0.0.0/4 dev lo` would. ***";
  }
  EXPECT_EQ(exchange(), 0) << "on this machine's network; see exchange() for the number";
}

TEST(LcmBusMulticast, SaysHowToAddARoute) {
  unsetenv("LCM_DEFAULT_URL");
  const int outcome = in_own_network(false, [] {
    const auto bus = LcmBus::open("");
    if (bus) return 2;
    const std::string& message = bus.error().message;
    return message.find("ip route add 224.0.0.0/4 dev lo") != std::string::npos ? 0 : 3;
  });
  if (outcome == kForbidden) {
    GTEST_SKIP()
        << "\n*** NOT TESTED: what a machine without a multicast route is told. The kernel "
           "allows no network namespace here. ***";
  }
  EXPECT_EQ(outcome, 0) << "2: it opened; 3: another message";
}

}  // namespace
}  // namespace anchord
