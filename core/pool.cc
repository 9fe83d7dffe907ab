#include "core/pool.h"

#include <algorithm>
#include <bit>
#include <new>

#include "core/scratch.h"

namespace anchord {
namespace {

#ifdef ANCHORD_SANITIZED
constexpr bool kReuse = false;  // what is given back must not be touched
#else
constexpr bool kReuse = true;
#endif

/// Sizes are multiples of a step and, beyond those, powers of two.
constexpr std::size_t kStep = 64, kSteps = 64, kPowers = 8;
constexpr std::size_t kLargest = kStep * kSteps << kPowers, kMostKept = std::size_t{8} << 20;

struct Free {
  Free* next;
};

/// What a thread keeps, by size. It has no destructor, for what ends after AtEnd.
struct Kept {
  Free* first[kSteps + kPowers];
  std::size_t bytes;
  bool closed;
};
[[gnu::tls_model("initial-exec")]] thread_local constinit Kept kept{};  // as Scratch::free_

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

struct Size {
  std::size_t number, bytes;
};

Size size_for(std::size_t bytes) {
  if (bytes <= kStep * kSteps) {
    const std::size_t steps = std::max<std::size_t>((bytes + kStep - 1) / kStep, 1);
    return {steps - 1, steps * kStep};
  }
  const std::size_t power = std::bit_ceil(bytes);
  return {kSteps + std::countr_zero(power / (kStep * kSteps)) - 1, power};
}

}  // namespace

void* Pool::allocate(std::size_t size) {
  if (!kReuse || size > kLargest) return ::operator new(size);
  const auto [number, bytes] = size_for(size);
  Free*& first = kept.first[number];
  if (!first) return ::operator new(bytes);
  kept.bytes -= bytes;
  return std::exchange(first, first->next);
}

void Pool::deallocate(void* memory, std::size_t size) noexcept {
  const auto [number, bytes] = size_for(size);
  if (!kReuse || size > kLargest || kept.closed || kept.bytes + bytes > kMostKept)
    return ::operator delete(memory);
  if (kept.bytes == 0) at_end.watch();  // makes it, the first time
  kept.bytes += bytes;
  kept.first[number] = new (memory) Free{kept.first[number]};
}

}  // namespace anchord
