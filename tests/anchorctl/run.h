#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <string>

#include "tests/anchorctl/utc.h"

namespace anchord {

struct Outcome {
  int status = -1;
  std::string output;
};

/// Runs anchorctl by a shell; `arguments` may redirect.
inline Outcome run(const std::string& arguments, const std::string& environment = "") {
  use_utc();
  const std::string command = environment + " '" ANCHORCTL "' " + arguments;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return {};
  Outcome outcome;
  char bytes[4096];
  while (const std::size_t size = std::fread(bytes, 1, sizeof bytes, pipe)) {
    outcome.output.append(bytes, size);
  }
  const int ended = pclose(pipe);
  outcome.status = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
  return outcome;
}

}  // namespace anchord
