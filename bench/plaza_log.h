#pragma once

#include <string>
#include <vector>

#include "core/frame.h"
#include "knowledge/knowledge.h"

namespace anchord::bench {

/// The frames of an LCM log, and the knowledge of a configuration file. Where they cannot be read
/// the program says why and ends.
std::vector<Frame> read_log(const std::string& path);
Knowledge read_knowledge(const std::string& path);

inline constexpr char kPlazaLog[] = "data/plaza.lcm";
inline constexpr char kPlazaConfig[] = "config/plaza.json";

}  // namespace anchord::bench
