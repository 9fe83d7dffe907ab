// What stands in the way of a start is told, and what systemd is told.

#include <sched.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "knowledge/frame_log.h"
#include "knowledge/sqlite.h"
#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

/// The start fails with one line that has all of `words` in it; liblcm may say more before it.
void expect_failure(DaemonProcess& daemon, const std::vector<std::string>& words, int status = 1) {
  EXPECT_EQ(daemon.wait(), status);
  const std::string errors = daemon.errors();
  const auto line = errors.find("anchord: ");
  ASSERT_NE(line, std::string::npos) << errors;
  EXPECT_EQ(errors.find('\n', line), errors.size() - 1) << errors;
  for (const auto& word : words) EXPECT_NE(errors.find(word, line), std::string::npos) << errors;
}

TEST(Start, OneDaemonPerDataDirectory) {
  TestFolder folder;
  DaemonProcess first(folder);
  ASSERT_TRUE(first.ready());
  DaemonProcess second(folder);
  expect_failure(second, {folder / "data", "in use", "--data"});
  EXPECT_EQ(counter(first.port(), "/log/frames"), 0) << "the first goes on";
}

TEST(Start, PortInUse) {
  TestFolder folder;
  DaemonProcess first(folder);
  ASSERT_TRUE(first.ready());
  DaemonProcess::Options same_port;
  same_port.data = "other";
  same_port.http = "127.0.0.1:" + std::to_string(first.port());
  DaemonProcess second(folder, same_port);
  expect_failure(second, {std::to_string(first.port()), "in use", "--http"});
}

TEST(Start, WhatIsNoAddressOrNetwork) {
  TestFolder folder;
  DaemonProcess::Options no_address;
  no_address.http = "localhost";
  DaemonProcess without_port(folder, no_address);
  expect_failure(without_port, {"localhost", "127.0.0.1:7780"}, 2);
  DaemonProcess::Options no_network;
  no_network.lcm = "nowhere://";
  DaemonProcess nowhere(folder, no_network);
  expect_failure(nowhere, {"nowhere://", "udpm://"}, 2);
}

TEST(Start, DataDirectoryThatCannotBe) {
  TestFolder folder;
  folder.write("file", "");
  DaemonProcess::Options in_a_file;
  in_a_file.data = "file/data";
  DaemonProcess daemon(folder, in_a_file);
  expect_failure(daemon, {folder / "file/data", "--data"});
}

TEST(Start, DataDirectoryThatIsNotWritable) {
  TestFolder folder;
  using std::filesystem::perms;
  constexpr perms kReadable = perms::owner_read | perms::owner_exec | perms::group_read |
                              perms::group_exec | perms::others_read | perms::others_exec;
  std::filesystem::permissions(folder / "", kReadable | perms::owner_write);
  std::filesystem::create_directory(folder / "data");
  std::filesystem::permissions(folder / "data", kReadable);
  DaemonProcess::Options options;
  if (geteuid() == 0)  // root may write everywhere: somebody else is to run it
    options.prepare = [] { return setgid(65534) == 0 && setuid(65534) == 0 ? 0 : 127; };
  DaemonProcess daemon(folder, options);
  if (daemon.wait() == 127)
    GTEST_SKIP() << "\n*** NOT TESTED: a data directory without the right to write. Only root may "
                    "run the program here. ***";
  expect_failure(daemon, {folder / "data", "write", "--data"});
}

TEST(Start, DatabaseOfANewerVersion) {
  TestFolder folder;
  ASSERT_TRUE(FrameLog::open(folder / "data").ok());
  {
    auto database = sqlite::Database::open(folder / "data/anchord.db");
    ASSERT_TRUE(database->execute("PRAGMA user_version=999").ok());
  }
  DaemonProcess daemon(folder);
  expect_failure(daemon, {"anchord.db", "version 999", "newer"});
}

TEST(Start, NoMulticastRoute) {
  constexpr int kForbidden = 77;
  TestFolder folder;
  DaemonProcess::Options lonely;
  lonely.lcm = "udpm://239.255.76.67:7667?ttl=0";
  lonely.prepare = [] {  // a network of its own that has no route
    return unshare(CLONE_NEWNET) == 0 || unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0 ? 0
                                                                                    : kForbidden;
  };
  DaemonProcess daemon(folder, lonely);
  if (daemon.wait() == kForbidden)
    GTEST_SKIP() << "\n*** NOT TESTED: a start without a multicast route. The kernel allows no "
                    "network namespace here. ***";
  EXPECT_EQ(daemon.wait(), 1);
  EXPECT_NE(daemon.errors().find("ip route add 224.0.0.0/4 dev lo"), std::string::npos)
      << daemon.errors();
}

TEST(Start, EveryMistakeOfAConfigurationOnALineOfItsOwn) {
  TestFolder folder;
  const auto file = folder.write("wrong.json", R"({
    "world": {"bounds": {"min": [0, 0, 0], "max": [10, 8, 3]}, "dimension": 3},
    "sensors": {"kinect": {"clutter_density": -1}},
    "classes": {"default": {"detection_probability": 2}}})");
  DaemonProcess daemon(folder, {}, {"--config", file, "--data", folder / "data"});
  EXPECT_EQ(daemon.wait(), 2);
  const std::string errors = daemon.errors();
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 3) << errors;
  for (const char* path : {": world.dimension:", ": sensors.kinect.clutter_density:",
                           ": classes.default.detection_probability:"})
    EXPECT_NE(errors.find(file + path), std::string::npos) << errors;
  EXPECT_FALSE(std::filesystem::exists(folder / "data"));
}

TEST(Start, WrongCalls) {
  TestFolder folder;
  DaemonProcess unknown(folder, {}, {"--colour", "red"});
  EXPECT_EQ(unknown.wait(), 2);
  DaemonProcess missing(folder, {}, {"--config", folder / "none.json"});
  EXPECT_EQ(missing.wait(), 2);
  EXPECT_NE(missing.errors().find("none.json"), std::string::npos);
}

TEST(Start, TellsSystemd) {
  TestFolder folder;
  const std::string path = folder / "notify";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(path.size(), sizeof address.sun_path);
  path.copy(address.sun_path, path.size());
  const int manager = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ASSERT_EQ(::bind(manager, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  std::string told;
  const auto hears = [&](const std::string& sign) {
    return eventually([&] {
      char bytes[1024];
      const ssize_t size = ::recv(manager, bytes, sizeof bytes, MSG_DONTWAIT);
      if (size > 0) told.append(bytes, static_cast<std::size_t>(size)).append("\n");
      return told.find(sign) != std::string::npos;
    });
  };
  DaemonProcess::Options under_systemd;
  under_systemd.environment = {"NOTIFY_SOCKET=" + path};
  DaemonProcess daemon(folder, under_systemd);
  EXPECT_TRUE(hears("READY=1\n")) << told;
  told.clear();
  EXPECT_TRUE(hears("WATCHDOG=1\n")) << told;
  EXPECT_TRUE(hears("WATCHDOG=1\nWATCHDOG=1\n")) << "and again, without any frame: " << told;
  EXPECT_EQ(daemon.end(SIGTERM), 0);
  EXPECT_TRUE(hears("STOPPING=1\n")) << told;
  ::close(manager);
}

}  // namespace
}  // namespace anchord
