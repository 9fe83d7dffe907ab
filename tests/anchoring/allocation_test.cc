// A warm engine asks the system for next to no memory.

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <random>

#include "anchoring/association.h"
#include "core/scratch.h"
#include "tests/anchoring/dice.h"
#include "tests/anchoring/small_world.h"

namespace {
std::size_t allocations = 0;
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace anchord {
namespace {

TEST(Allocation, AWarmEngineAsksTheSystemForNextToNone) {
#ifdef ANCHORD_SANITIZED
  GTEST_SKIP() << "with the sanitizer nothing is kept to be used again";
#endif
  std::mt19937_64 random(1);
  enumeration::Dice dice(random);
  const Background background(small_world());
  World empty(small_world());
  Belief belief = *empty.belief();
  std::size_t warm = 0, cold = 0;
  double hypotheses = 0;
  for (int step = 0; step < 600; ++step) {
    const MapFrame placed =
        place_in_map(frame(0.1 * step, rows(dice, 12, 6, 2, 0.05, 0.3)), background).value();
    const Visibility visibility(placed, background);
    const std::size_t before = allocations;
    fold(belief, placed, visibility, background);
    (step < 300 ? cold : warm) += allocations - before;
    for (const auto& cluster : belief.clusters)
      hypotheses += static_cast<double>(cluster->hypotheses.size()) / 600;
  }
  EXPECT_GT(hypotheses, 20) << "the scene must be work";
  EXPECT_GT(cold, 100u) << "the count must count";
  // Now and then there is more of something than ever before, or a name for what is new.
  EXPECT_LT(warm, 300u / 2) << "in 300 frames";
}

TEST(Allocation, WhatAScratchOnceTookIsThereTheNextTime) {
#ifdef ANCHORD_SANITIZED
  GTEST_SKIP() << "with the sanitizer each piece is on its own";
#endif
  const auto work = [] {
    const Scratch outer;
    const ScratchVector<char> little(1000);
    const Scratch inner;
    const ScratchVector<char> much(1 << 23);  // more than any block so far
  };
  work();
  const std::size_t before = allocations;
  work();
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace anchord
