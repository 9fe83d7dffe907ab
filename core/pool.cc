#include "core/pool.h"

#include <new>

#include "core/scratch.h"

namespace anchord {
namespace {

#ifdef ANCHORD_SANITIZED
constexpr bool kReuse = false;  // what is given back must not be touched
#else
constexpr bool kReuse = true;
#endif

constexpr std::size_t kStep = 64, kLargest = 4096, kMostKept = std::size_t{8} << 20;

struct Free {
  Free* next;
};

/// What a thread keeps, by size. It has no destructor, for what ends after AtEnd.
struct Kept {
  Free* first[kLargest / kStep + 1];
  std::size_t bytes;
  bool closed;
};
thread_local constinit Kept kept{};

/// Gives it all back when the thread ends.
struct AtEnd {
  ~AtEnd() {
    kept.closed = true;
    for (Free*& first : kept.first)
      while (first) ::operator delete(std::exchange(first, first->next));
  }
  void watch() {}
};
thread_local AtEnd at_end;

std::size_t steps_of(std::size_t size) { return (size + kStep - 1) / kStep; }

}  // namespace

void* Pool::allocate(std::size_t size) {
  if (!kReuse || size > kLargest) return ::operator new(size);
  const std::size_t steps = steps_of(size);
  Free*& first = kept.first[steps];
  if (!first) return ::operator new(steps* kStep);
  kept.bytes -= steps * kStep;
  return std::exchange(first, first->next);
}

void Pool::deallocate(void* memory, std::size_t size) noexcept {
  const std::size_t steps = steps_of(size);
  if (!kReuse || size > kLargest || kept.closed || kept.bytes + steps * kStep > kMostKept)
    return ::operator delete(memory);
  if (kept.bytes == 0) at_end.watch();  // makes it, the first time
  kept.bytes += steps * kStep;
  kept.first[steps] = new (memory) Free{kept.first[steps]};
}

}  // namespace anchord
