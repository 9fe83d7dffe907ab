#include "core/scratch.h"

#include <algorithm>
#include <memory>

namespace anchord {

/// A thread's blocks. Only the last one has room.
struct ScratchBlocks {
  struct Block {
    std::unique_ptr<std::byte[]> memory;
    std::size_t size;
  };
  std::vector<Block> blocks;

  std::size_t used() const {
    return blocks.empty() ? 0 : blocks.back().size - (Scratch::free_.end - Scratch::free_.next);
  }
  void add(std::size_t least) {
    constexpr std::size_t kFirst = std::size_t{1} << 18;
    const std::size_t size = std::max({least, kFirst, 2 * all()});
    blocks.push_back({std::unique_ptr<std::byte[]>(new std::byte[size]), size});
    set_used(0);
  }
  /// What was taken since goes. If all goes, one block is left, large enough for all that there
  /// ever was at a time.
  void go_back(std::size_t block, std::size_t its_used) {
    if (blocks.size() > 1) most_ = std::max(most_, all());
    if (block <= 1 && its_used == 0 && !blocks.empty() && blocks.front().size < most_) {
      blocks.clear();
      add(most_);
    }
    while (blocks.size() > std::max<std::size_t>(block, 1)) blocks.pop_back();
    if (!blocks.empty()) set_used(its_used);
  }

 private:
  std::size_t most_ = 0;  // of all()

  void set_used(std::size_t used) {
    std::byte* const begin = blocks.back().memory.get();
    Scratch::free_ = {begin + used, begin + blocks.back().size};
  }
  std::size_t all() const {
    std::size_t sum = 0;
    for (const Block& block : blocks) sum += block.size;
    return sum;
  }
};

namespace {
thread_local ScratchBlocks t_blocks;
}  // namespace

Scratch::Scratch() : block_(t_blocks.blocks.size()), used_(t_blocks.used()) {}

Scratch::~Scratch() { t_blocks.go_back(block_, used_); }

void* Scratch::allocate_more(std::size_t size) {
  t_blocks.add(size);
  return std::exchange(free_.next, free_.next + size);
}

}  // namespace anchord
