#pragma once

#include <boost/container/small_vector.hpp>
#include <cstddef>
#include <new>
#include <utility>
#include <vector>

#include "core/memory_allocator.h"

#if defined(__SANITIZE_ADDRESS__)
#define ANCHORD_SANITIZED  // each piece on its own, so that the sanitizer sees it
#elif defined(__clang__)   // others may have a __has_feature of somebody's header
#if __has_feature(address_sanitizer)
#define ANCHORD_SANITIZED
#endif
#endif

namespace anchord {

/// Memory for what does not outlive the work on one frame: taken from a block of this thread by
/// moving a pointer on, and given back all at once, all that was taken since a Scratch began, when
/// it ends. The block stays for the next frame, so that a warm engine asks the system for none.
///
/// Containers of it that are older than a Scratch must not grow while it lasts, those that are
/// younger must end before it does.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  /// `size` bytes, aligned for anything that new aligns.
  static void* allocate(std::size_t size) {
#ifdef ANCHORD_SANITIZED
    return ::operator new(size);
#else
    constexpr std::size_t kAlignment = alignof(std::max_align_t);
    size = (size + kAlignment - 1) / kAlignment * kAlignment;
    if (size > static_cast<std::size_t>(free_.end - free_.next)) return allocate_more(size);
    return std::exchange(free_.next, free_.next + size);
#endif
  }
  /// Nothing is given back before the Scratch ends.
  static void deallocate([[maybe_unused]] void* memory, std::size_t) noexcept {
#ifdef ANCHORD_SANITIZED
    ::operator delete(memory);
#endif
  }

 private:
  friend struct ScratchBlocks;
  /// What is left of this thread's last block. Initial-exec: where it stands is read, not asked for
  /// with a call, before and after which every register would have to be saved.
  struct Free {
    std::byte *next, *end;
  };
  [[gnu::tls_model("initial-exec")]] static inline thread_local constinit Free free_{nullptr,
                                                                                     nullptr};
  static void* allocate_more(std::size_t size);

  std::size_t block_, used_;  // where it began
};

template <typename T>
using ScratchAllocator = MemoryAllocator<T, Scratch>;

template <typename T>
using ScratchVector = std::vector<T, ScratchAllocator<T>>;

/// With room for N elements of its own.
template <typename T, std::size_t N>
using SmallScratchVector = boost::container::small_vector<T, N, ScratchAllocator<T>>;

}  // namespace anchord
