#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace anchord {

/// One thread that does tasks in the order in which they came, of which at most `capacity` wait.
class Worker {
 public:
  explicit Worker(std::size_t capacity);
  /// stop().
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// False if too many wait, or after stop(): the task is not done then. Safe from any thread.
  bool post(std::function<void()> task);

  /// Does what waits, then ends for good. Not from a task.
  void stop();

 private:
  void run();

  std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> tasks_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace anchord
