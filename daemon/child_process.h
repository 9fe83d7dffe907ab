#pragma once

#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

#include "core/result.h"

namespace anchord {

/// Another program, with a stream socket to it. It gets nothing else that this process has open but
/// standard error.
class ChildProcess {
 public:
  /// Starts `program`, which finds its end of the socket at descriptor `at`, above 2.
  static Result<std::unique_ptr<ChildProcess>> start(const std::string& program,
                                                     std::vector<std::string> arguments, int at);
  /// end().
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// This process' end.
  int socket() const { return socket_; }

  /// Kills it unless it has ended, and says how it ended: "status 1", "signal 11". Once.
  std::string end();

 private:
  ChildProcess(pid_t pid, int socket) : pid_(pid), socket_(socket) {}

  pid_t pid_;  ///< 0: it has ended
  int socket_;
};

}  // namespace anchord
