#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/api/http_client.h"
#include "tests/daemon/scene.h"

namespace anchord {

/// The program itself, in a process of its own, with `kScene`, unless said otherwise, and a data
/// directory in `folder`. On a free port, and on an LCM network that holds nobody else, unless said
/// otherwise.
class DaemonProcess {
 public:
  struct Options {
    std::string data = "data";  ///< in the folder
    std::string lcm = "memq://";
    std::string http = "127.0.0.1:0";      ///< port 0: a free one
    std::string scene = kScene;            ///< the configuration
    std::vector<std::string> environment;  ///< NAME=VALUE, beside that of the test
    std::string checkpoint_interval = {};  ///< s; empty: the default
    /// In the child before it becomes the daemon; it ends with this status unless that is 0.
    std::function<int()> prepare;
  };
  /// Starts it; `arguments` replace all of the daemon's if there are any.
  DaemonProcess(const TestFolder& folder, Options options, std::vector<std::string> arguments = {});
  explicit DaemonProcess(const TestFolder& folder) : DaemonProcess(folder, Options{}) {}
  /// Kills it.
  ~DaemonProcess();
  DaemonProcess(const DaemonProcess&) = delete;
  DaemonProcess& operator=(const DaemonProcess&) = delete;

  /// Waits until it serves; false if it ends instead.
  bool ready();
  /// The port, once ready().
  std::uint16_t port() const { return port_; }
  pid_t pid() const { return pid_; }
  /// What it has written on standard error so far.
  std::string errors() const;

  /// Sends a signal and waits for its end: its exit status, or minus the signal that ended it.
  int end(int signal);
  /// Waits for its end.
  int wait();

  bool ended();

 private:
  std::string errors_file_;
  pid_t pid_ = -1;
  bool ended_ = false;
  int status_ = 0;
  std::uint16_t port_ = 0;
};

/// One request on a connection of its own.
Answer ask(std::uint16_t port, const std::string& request);
/// The body of what it answers, which must be 200.
std::string body(std::uint16_t port, const std::string& target);
/// Everything that is believed, as bytes.
std::string belief(std::uint16_t port);
/// A number in GET /v1/status, such as "/frames/refused".
std::int64_t counter(std::uint16_t port, const std::string& pointer);
/// Whether a condition comes true; gives up only where it would hang.
bool eventually(const std::function<bool()>& condition);

}  // namespace anchord
