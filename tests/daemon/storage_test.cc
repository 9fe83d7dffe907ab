// A disk that is full: the daemon answers on, refuses frames, and takes them once there is room.

#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <cerrno>
#include <csignal>
#include <filesystem>

#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

Answer send(const DaemonProcess& daemon, int number) {
  return ask(daemon.port(), post("/v1/detections", json(frame_number(number))));
}

/// Fills the disk with frames; `make_room` makes it take more.
void expect_recovery(const TestFolder& folder, const DaemonProcess::Options& options,
                     const std::function<void(const DaemonProcess&)>& make_room) {
  std::string after;
  {
    DaemonProcess daemon(folder, options);
    ASSERT_TRUE(daemon.ready());
    int number = 1;
    std::string durable;
    Answer answer = send(daemon, number);
    while (answer.status == 200 && number < 5000) {
      if (number % 50 == 0) durable = belief(daemon.port());
      answer = send(daemon, ++number);
    }
    ASSERT_EQ(answer.status, 507) << answer.body;
    EXPECT_NE(answer.body.find("insufficient_storage"), std::string::npos) << answer.body;
    EXPECT_NE(answer.body.find("frame log"), std::string::npos) << answer.body;
    durable = belief(daemon.port());
    EXPECT_EQ(counter(daemon.port(), "/log/frames"), number - 1);
    EXPECT_EQ(send(daemon, number).status, 507);
    EXPECT_EQ(send(daemon, number + 1).status, 507);
    EXPECT_EQ(belief(daemon.port()), durable);
    EXPECT_EQ(counter(daemon.port(), "/frames/unstored"), 3);
    EXPECT_EQ(counter(daemon.port(), "/frames/refused"), 3);
    EXPECT_EQ(send(daemon, number - 1).body, "{\"accepted\":0,\"repeated\":1}\n");

    EXPECT_EQ(daemon.end(SIGKILL), -SIGKILL);
    DaemonProcess again(folder, options);
    ASSERT_TRUE(again.ready()) << "it starts on a full disk, too";
    EXPECT_EQ(belief(again.port()), durable);
    EXPECT_EQ(send(again, number).status, 507);
    make_room(again);
    for (int more = 0; more < 5; ++more) EXPECT_EQ(send(again, number + more).status, 200);
    after = belief(again.port());
    EXPECT_NE(after, durable);
    EXPECT_EQ(counter(again.port(), "/log/frames"), number + 4);
    EXPECT_EQ(again.end(SIGKILL), -SIGKILL);
  }
  DaemonProcess restarted(folder);
  ASSERT_TRUE(restarted.ready());
  EXPECT_EQ(belief(restarted.port()), after);
}

TEST(Storage, FilesThatMayNotGrow) {
  TestFolder folder;
  DaemonProcess::Options options;
  options.prepare = [] {
    std::signal(SIGXFSZ, SIG_IGN);  // so that the write fails instead
    const rlimit limit{300'000, RLIM_INFINITY};
    return setrlimit(RLIMIT_FSIZE, &limit) == 0 ? 0 : 127;
  };
  expect_recovery(folder, options, [](const DaemonProcess& daemon) {
    const rlimit limit{RLIM_INFINITY, RLIM_INFINITY};
    ASSERT_EQ(prlimit(daemon.pid(), RLIMIT_FSIZE, &limit, nullptr), 0);
  });
}

TEST(Storage, AFullFileSystem) {
  TestFolder folder;
  const std::string data = folder / "data";
  std::filesystem::create_directory(data);
  // Mounted where this thread and what it starts see it, and nobody else.
  if (unshare(CLONE_NEWNS) != 0 || mount("", "/", "", MS_REC | MS_PRIVATE, "") != 0 ||
      mount("tmpfs", data.c_str(), "tmpfs", 0, "size=1m") != 0)
    GTEST_SKIP() << "\n*** NOT TESTED: a full file system. Nothing may be mounted here ("
                 << std::strerror(errno) << "). ***";
  std::ofstream(data + "/other") << std::string(600'000, 'x');
  expect_recovery(folder, {},
                  [&](const DaemonProcess&) { std::filesystem::remove(data + "/other"); });
  umount(data.c_str());
}

}  // namespace
}  // namespace anchord
