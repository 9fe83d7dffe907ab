#pragma once

#include <cstdint>
#include <utility>

#include "core/scratch.h"

namespace anchord {

/// Numbers by 64-bit keys that are hashes already: open addressing in scratch memory. Equal keys may
/// come several times.
class HashTable {
 public:
  explicit HashTable(std::size_t most) {
    std::size_t slots = 16;
    while (slots < 2 * most) slots *= 2;
    slots_.assign(slots, {0, kEmpty});
  }

  /// At most as often as said at first.
  void insert(std::uint64_t key, int number) {
    std::size_t at = key & (slots_.size() - 1);
    while (slots_[at].second != kEmpty) at = (at + 1) & (slots_.size() - 1);
    slots_[at] = {key, number};
  }

  /// The first number of that key for which `fits` holds, or -1.
  template <typename Fits>
  int find(std::uint64_t key, const Fits& fits) const {
    for (std::size_t at = key & (slots_.size() - 1); slots_[at].second != kEmpty;
         at = (at + 1) & (slots_.size() - 1))
      if (slots_[at].first == key && fits(slots_[at].second)) return slots_[at].second;
    return kEmpty;
  }
  int find(std::uint64_t key) const {
    return find(key, [](int) { return true; });
  }

 private:
  static constexpr int kEmpty = -1;
  ScratchVector<std::pair<std::uint64_t, int>> slots_;
};

}  // namespace anchord
