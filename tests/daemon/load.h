#pragma once

#include <atomic>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/daemon/daemon_process.h"

namespace anchord {

/// Sends numbered frames, each from a number of its own, until the daemon is gone.
class Load {
 public:
  Load(std::uint16_t port, std::atomic<int>& next) {
    for (const char* sensor : {"kinect", "laser"})
      threads_.emplace_back([this, port, &next, sensor] {
        Client client(port);
        while (true) {
          const int number = ++next;
          client.send(post("/v1/detections", json(frame_number(number, sensor))));
          const Answer answer = client.receive();
          if (answer.status != 200) return;  // 0: it is gone; 503: it ends
          std::lock_guard lock(mutex_);
          acknowledged_.insert({sensor, frame_number(number).utime});
        }
      });
  }
  ~Load() { join(); }
  void join() {
    for (auto& thread : threads_)
      if (thread.joinable()) thread.join();
  }
  std::size_t count() {
    std::lock_guard lock(mutex_);
    return acknowledged_.size();
  }
  /// Once joined.
  const std::set<std::pair<std::string, Utime>>& acknowledged() const { return acknowledged_; }

 private:
  std::mutex mutex_;
  std::set<std::pair<std::string, Utime>> acknowledged_;
  std::vector<std::thread> threads_;
};

}  // namespace anchord
