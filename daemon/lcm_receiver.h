#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/result.h"
#include "daemon/child_process.h"
#include "daemon/lcm_records.h"

namespace anchord {

/// Hears an LCM network through a process of its own (see receive_lcm()): what others send can
/// bring liblcm down, and then it is that process that dies. It is started again at once.
class LcmReceiver {
 public:
  /// Called with each message and refusal: on the receiver's thread, or in start().
  using Handler = std::function<void(const LcmRecord&)>;

  /// Since the start. Read by any thread.
  struct Counters {
    std::atomic<bool> receiving{false};
    std::atomic<std::uint64_t> restarts{0};
    std::atomic<std::uint64_t> dropped{0};            ///< messages; see LcmDrops
    std::atomic<std::uint64_t> dropped_by_kernel{0};  ///< datagrams
  };

  /// Joins the network, or says why that cannot be; hears nothing before start(). `program` is one
  /// whose main() calls receive_lcm(); `url` is an effective one.
  static Result<std::unique_ptr<LcmReceiver>> open(std::string program, std::string url);
  /// stop().
  ~LcmReceiver();
  LcmReceiver(const LcmReceiver&) = delete;
  LcmReceiver& operator=(const LcmReceiver&) = delete;

  /// Starts receiving, once. What is sent after it has returned is heard.
  void start(Handler handler);
  /// Ends receiving for good and returns when the handler does not run any more. Not from it.
  void stop();

  const Counters& counters() const { return counters_; }

 private:
  using Clock = std::chrono::steady_clock;

  LcmReceiver(std::string program, std::string url, int wake);
  Status spawn();
  void begin();
  void await(const std::function<bool()>& condition);
  void run();
  void pass_on();
  void take(const LcmRecord& record);
  void ended();
  bool woken_within(std::chrono::milliseconds time) const;

  std::string program_, url_;
  int wake_;  ///< eventfd, readable once the thread shall end
  Handler handler_;
  Counters counters_;
  std::thread thread_;
  // Of that thread once it runs:
  std::unique_ptr<ChildProcess> child_;
  LcmRecords records_;
  std::vector<std::uint8_t> buffer_;
  Clock::time_point spawned_, told_;
  bool joined_ = false;
  int failures_ = 0;  ///< starts in a row that came to nothing
  std::string why_;   ///< of the last one
};

}  // namespace anchord
