#pragma once

#include <string>

#include "bench/crowd.h"

namespace anchord::bench {

/// Writes a scene so that other programs can read it: PREFIX.frames.jsonl (frames as anchor-replay
/// takes them), PREFIX.json (the configuration), PREFIX.truth.csv (frame,id,x,y) and
/// PREFIX.index.csv (utime,frame), the truth from frame `first` on. False if it cannot be written.
bool write_crowd(const Crowd& crowd, const CrowdParameters& parameters, int first,
                 const std::string& prefix);

}  // namespace anchord::bench
