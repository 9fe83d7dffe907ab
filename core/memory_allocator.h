#pragma once

#include <cstddef>

namespace anchord {

/// Gives containers the memory of `Memory`: what its static allocate(size) gives and
/// deallocate(memory, size) takes back.
template <typename T, typename Memory>
struct MemoryAllocator {
  using value_type = T;
  MemoryAllocator() = default;
  template <typename U>
  MemoryAllocator(const MemoryAllocator<U, Memory>&) {}  // NOLINT: allocators convert
  T* allocate(std::size_t n) { return static_cast<T*>(Memory::allocate(n * sizeof(T))); }
  void deallocate(T* memory, std::size_t n) noexcept { Memory::deallocate(memory, n * sizeof(T)); }
  bool operator==(const MemoryAllocator&) const { return true; }
};

}  // namespace anchord
