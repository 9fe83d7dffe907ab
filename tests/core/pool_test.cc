#include "core/pool.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <thread>

namespace anchord {
namespace {

TEST(Pool, IsAlignedForEverythingAndApart) {
  std::vector<std::pair<char*, std::size_t>> pieces;
  for (std::size_t size = 1; size < 3000000; size = size * 9 / 8 + 37)
    pieces.push_back({static_cast<char*>(Pool::allocate(size)), size});
  std::set<std::pair<char*, char*>> extents;
  for (const auto& [memory, size] : pieces) {
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % alignof(std::max_align_t), 0u);
    std::fill(memory, memory + size, 'x');
    extents.insert({memory, memory + size});
  }
  for (auto it = extents.begin(), next = std::next(it); next != extents.end(); ++it, ++next)
    EXPECT_LE(it->second, next->first);
  for (const auto& [memory, size] : pieces) Pool::deallocate(memory, size);
}

TEST(Pool, ContainersKeepWhatTheyHold) {
  for (int round = 0; round < 3; ++round) {
    std::vector<std::shared_ptr<PoolVector<int>>> many;
    for (int i = 0; i < 1000; ++i) many.push_back(make_pooled<PoolVector<int>>(i % 100, i));
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(*many[i], PoolVector<int>(i % 100, i));
  }
}

/// Beliefs are read, and let go, by other threads than the one that makes them.
TEST(Pool, WhatOneThreadMakesAnotherMayLetGo) {
  for (int round = 0; round < 20; ++round) {
    std::vector<std::shared_ptr<const PoolVector<int>>> made;
    for (int i = 0; i < 500; ++i) made.push_back(make_pooled<const PoolVector<int>>(i, round));
    std::thread reader([made = std::move(made), round]() mutable {
      for (std::size_t i = 1; i < made.size(); ++i) EXPECT_EQ(made[i]->back(), round);
      made.clear();
    });
    reader.join();
  }
}

}  // namespace
}  // namespace anchord
