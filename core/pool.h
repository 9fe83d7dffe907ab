#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "core/memory_allocator.h"

namespace anchord {

/// Memory for what outlives a frame, and is made anew by the thousand in each: what is given back
/// is kept by the thread that gives it back, to be taken again, so that a warm engine asks the
/// system for next to none. Each thread keeps a few MiB at most.
class Pool {
 public:
  /// `size` bytes, aligned for anything that new aligns.
  static void* allocate(std::size_t size);
  /// From any thread; of the same size.
  static void deallocate(void* memory, std::size_t size) noexcept;
};

template <typename T>
using PoolAllocator = MemoryAllocator<T, Pool>;

template <typename T>
using PoolVector = std::vector<T, PoolAllocator<T>>;

/// std::make_shared() with memory of the pool.
template <typename T, typename... Arguments>
std::shared_ptr<T> make_pooled(Arguments&&... arguments) {
  return std::allocate_shared<T>(PoolAllocator<std::remove_const_t<T>>(),
                                 std::forward<Arguments>(arguments)...);
}

}  // namespace anchord
