#pragma once

#include <cstddef>

#include "core/scratch.h"

namespace anchord {

/// What it is worth to give each detection to each leaf that it may be given to, rather than to
/// none: one row for each detection, one column for each leaf, sparse.
class PairGains {
 public:
  struct Entry {
    int leaf;
    double gain;
  };
  struct Row {
    const Entry *first, *last;
    const Entry* begin() const { return first; }
    const Entry* end() const { return last; }
  };

  PairGains(int detections, int leaves) : leaves_(leaves) { first_.reserve(detections + 1); }

  /// With a row of so many pairs for each detection, in which put() puts them.
  PairGains(const ScratchVector<std::size_t>& pairs, int leaves) : leaves_(leaves) {
    first_.reserve(pairs.size());
    std::size_t all = 0;
    for (const std::size_t of_detection : pairs) {
      first_.push_back(all);
      all += of_detection;
    }
    entries_.resize(all);
  }
  void put(int z, std::size_t i, Entry pair) { entries_[first_[z] + i] = pair; }

  /// The next detection's row, to which add() adds.
  void start_row() { first_.push_back(entries_.size()); }
  void add(int leaf, double gain) { entries_.push_back({leaf, gain}); }

  int detections() const { return static_cast<int>(first_.size()); }
  int leaves() const { return leaves_; }
  void set_leaves(int leaves) { leaves_ = leaves; }
  Row of(int z) const {
    const bool is_last = z + 1 == detections();
    return {entries_.data() + first_[z],
            entries_.data() + (is_last ? entries_.size() : first_[z + 1])};
  }

 private:
  int leaves_;
  ScratchVector<std::size_t> first_;  // per row: its first entry
  ScratchVector<Entry> entries_;
};

}  // namespace anchord
