#include "core/scratch.h"

#include <algorithm>
#include <memory>

#ifdef __has_feature  // clang
#if __has_feature(address_sanitizer)
#define ANCHORD_CLANG_ADDRESS
#endif
#endif

namespace anchord {
namespace {

constexpr std::size_t kFirstBlock = std::size_t{1} << 18, kAlignment = alignof(std::max_align_t);

/// A thread's blocks. Only the last one has room; `used` is that of it.
struct Blocks {
  struct Block {
    std::unique_ptr<std::byte[]> memory;
    std::size_t size;
  };
  std::vector<Block> blocks;
  std::size_t used = 0;

  void* take(std::size_t bytes) {
    bytes = (bytes + kAlignment - 1) / kAlignment * kAlignment;
    if (blocks.empty() || used + bytes > blocks.back().size) add(bytes);
    void* memory = blocks.back().memory.get() + used;
    used += bytes;
    return memory;
  }
  void add(std::size_t least) {
    const std::size_t size = std::max({least, kFirstBlock, 2 * all()});
    blocks.push_back({std::unique_ptr<std::byte[]>(new std::byte[size]), size});
    used = 0;
  }
  /// What was taken since goes. If all goes, one block is left, large enough for all of it.
  void go_back(std::size_t block, std::size_t its_used) {
    if (block == 0 && its_used == 0 && blocks.size() > 1) {
      const std::size_t room = all();
      blocks.clear();
      add(room);
    }
    while (blocks.size() > std::max<std::size_t>(block, 1)) blocks.pop_back();
    used = its_used;
  }

 private:
  std::size_t all() const {
    std::size_t sum = 0;
    for (const Block& block : blocks) sum += block.size;
    return sum;
  }
};

thread_local Blocks t_blocks;

}  // namespace

Scratch::Scratch() : block_(t_blocks.blocks.size()), used_(t_blocks.used) {}

Scratch::~Scratch() { t_blocks.go_back(block_, used_); }

#if defined(__SANITIZE_ADDRESS__) || defined(ANCHORD_CLANG_ADDRESS)
// So that the sanitizer sees each piece on its own.
void* Scratch::allocate(std::size_t size) { return ::operator new(size); }
void Scratch::deallocate(void* memory) { ::operator delete(memory); }
#else
void* Scratch::allocate(std::size_t size) { return t_blocks.take(size); }
void Scratch::deallocate(void*) {}
#endif

}  // namespace anchord
