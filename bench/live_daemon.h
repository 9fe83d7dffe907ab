#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "api/lcm_bus.h"
#include "bench/timing.h"
#include "core/frame.h"
#include "core/verification.h"
#include "daemon/service.h"

namespace anchord::bench {

/// Where its daemons and robots meet.
inline constexpr char kLcmUrl[] = "udpm://239.255.76.67:17699?ttl=0";

/// Ends the program with a message.
[[noreturn]] void fail(const std::string& message);

double ms_since(std::chrono::steady_clock::time_point begin);

/// A daemon in this process, on an LCM network of its own, with a log that goes when it goes.
class LiveDaemon {
 public:
  explicit LiveDaemon(Knowledge knowledge);
  ~LiveDaemon();
  LiveDaemon(const LiveDaemon&) = delete;
  LiveDaemon& operator=(const LiveDaemon&) = delete;

  std::uint16_t port() const { return port_; }

 private:
  std::uint16_t port_;
  ServiceOptions options_;
  std::filesystem::path directory_;
  std::unique_ptr<Service> service_;
};

/// Publishes frames over LCM in a steady rhythm and hears what the daemon believes after each.
class LiveRobot {
 public:
  LiveRobot();
  LiveRobot(const LiveRobot&) = delete;
  LiveRobot& operator=(const LiveRobot&) = delete;

  void play(const std::vector<Frame>& frames, double frames_per_second);
  void tell(const RobotPose& pose);

  /// From the publishing of a frame to the coming of the world after it. After stop() only.
  const Times& world_latency() const { return latency_; }
  void stop() { bus_->stop(); }

 private:
  void hear(std::span<const std::uint8_t> bytes);

  std::mutex mutex_;
  std::map<Utime, std::chrono::steady_clock::time_point> sent_;
  Times latency_;
  std::unique_ptr<LcmBus> bus_;  // ends before what its thread uses
};

}  // namespace anchord::bench
