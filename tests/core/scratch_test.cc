#include "core/scratch.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/hash_table.h"

namespace anchord {
namespace {

TEST(Scratch, ContainersKeepWhatTheyHold) {
  const Scratch scratch;
  ScratchVector<int> numbers;
  SmallScratchVector<double, 2> few;
  for (int i = 0; i < 100'000; ++i) {  // more than a block
    numbers.push_back(i);
    few.push_back(i);
  }
  EXPECT_EQ(std::accumulate(numbers.begin(), numbers.end(), std::int64_t{0}), 4'999'950'000);
  EXPECT_EQ(few[77'777], 77'777);
}

TEST(Scratch, WhatAnInnerOneTookGoesAndTheRestStays) {
  const Scratch outer;
  const ScratchVector<int> before(1000, 7);
  for (int round = 0; round < 3; ++round) {
    const Scratch inner;
    ScratchVector<int> much(1'000'000, round);
    EXPECT_EQ(much.back(), round);
  }
  ScratchVector<int> after(1000, 8);
  EXPECT_EQ(before, ScratchVector<int>(1000, 7));
  EXPECT_EQ(after, ScratchVector<int>(1000, 8));
}

TEST(Scratch, IsAlignedForEverything) {
  const Scratch scratch;
  for (int i = 1; i < 50; ++i) {
    const ScratchVector<char> odd(i);
    const ScratchVector<long double> wide(1);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(wide.data()) % alignof(std::max_align_t), 0u);
  }
}

TEST(HashTable, FindsWhatWasPutIn) {
  const Scratch scratch;
  HashTable table(1000);
  for (int i = 0; i < 1000; ++i) table.insert(i % 100, i);  // ten of each key, all in a row
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(table.find(i % 100, [i](int number) { return number == i; }), i);
    EXPECT_EQ(table.find(i % 100), i % 100) << "the first of them";
  }
  EXPECT_EQ(table.find(100), -1);
  EXPECT_EQ(table.find(7, [](int) { return false; }), -1);
}

}  // namespace
}  // namespace anchord
