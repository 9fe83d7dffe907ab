#include "bench/plaza_log.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "api/lcm_log.h"
#include "knowledge/configuration.h"

namespace anchord::bench {

std::vector<Frame> read_log(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  LcmLogReader log(stream);
  std::vector<Frame> frames;
  while (true) {
    auto message = log.next_frame();
    if (!message) {
      std::fprintf(stderr, "%s: %s\n", path.c_str(), message.error().text().c_str());
      std::exit(1);
    }
    if (!*message) break;
    frames.push_back(std::move((**message).frame));
  }
  if (frames.empty()) {
    std::fprintf(stderr, "%s holds no frames (start this from the project's root)\n", path.c_str());
    std::exit(1);
  }
  return frames;
}

Knowledge read_knowledge(const std::string& path) {
  const auto configuration = read_configuration(path);
  if (configuration.ok()) return configuration.knowledge();
  for (const auto& mistake : configuration.mistakes())
    std::fprintf(stderr, "%s: %s\n", path.c_str(), mistake.text().c_str());
  std::exit(2);
}

}  // namespace anchord::bench
