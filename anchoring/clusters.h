#pragma once

#include <cstddef>
#include <functional>
#include <iterator>
#include <memory>
#include <span>
#include <type_traits>

#include "anchoring/reach.h"
#include "core/pool.h"

namespace anchord {

/// The clusters of a belief, by where they are: chunks of neighbours, so that a look at a part of
/// the world costs what is there. A value whose copies share the chunks that did not change:
/// copying one costs a pointer for some dozens of clusters. A chunk that gets too large is halved
/// across its longer side. The order of clusters follows from the order of changes alone.
class Clusters {
 public:
  using Pointer = std::shared_ptr<const Cluster>;
  struct Entry {
    Pointer cluster;
    Reach reach;
    template <typename Archive>
    void serialize(Archive& archive) {
      archive(cluster, reach);
    }
  };
  struct Chunk {
    PoolVector<Entry> entries;
    Reach reach;  ///< of them all
    template <typename Archive>
    void serialize(Archive& archive) {
      archive(entries, reach);
    }
  };
  using Chunks = PoolVector<std::shared_ptr<const Chunk>>;

  class const_iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = Pointer;
    using difference_type = std::ptrdiff_t;
    using pointer = const Pointer*;
    using reference = const Pointer&;
    const_iterator() = default;
    explicit const_iterator(Chunks::const_iterator chunk) : chunk_(chunk) {}
    reference operator*() const { return (*chunk_)->entries[entry_].cluster; }
    pointer operator->() const { return &**this; }
    const_iterator& operator++() {
      if (++entry_ == (*chunk_)->entries.size()) ++chunk_, entry_ = 0;
      return *this;
    }
    const_iterator operator++(int) {
      const_iterator before = *this;
      ++*this;
      return before;
    }
    bool operator==(const const_iterator&) const = default;

   private:
    Chunks::const_iterator chunk_;
    std::size_t entry_ = 0;
  };
  const_iterator begin() const { return const_iterator(chunks_.begin()); }
  const_iterator end() const { return const_iterator(chunks_.end()); }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// Costs a step for each chunk.
  const Pointer& operator[](std::size_t index) const;

  /// Where a cluster stands until something is changed.
  struct Place {
    std::size_t chunk, entry;
  };

  /// Calls visit(Place, const Pointer&), in order, for every cluster of which may_meet(const
  /// Reach&) is true, and may_meet(const Entry&) if there is one. What a reach meets must be met by
  /// every reach that includes it.
  template <typename Meet, typename Visit>
  void visit(Meet may_meet, Visit visit) const {
    for (std::size_t c = 0; c < chunks_.size(); ++c) {
      if (!may_meet(chunks_[c]->reach)) continue;
      const auto& entries = chunks_[c]->entries;
      for (std::size_t e = 0; e < entries.size(); ++e)
        if (meets(may_meet, entries[e])) visit(Place{c, e}, entries[e].cluster);
    }
  }

  /// Takes out the clusters in those places (in order) and puts in others, each near where it is.
  void exchange(std::span<const Place> gone, std::span<const Pointer> come,
                const Background& background);

  /// As with a vector, but for where what is added comes to stand.
  void add(Pointer cluster, const Background& background);
  void erase(std::size_t index);
  void replace(std::size_t index, Pointer cluster, const Background& background);

  /// The same clusters in the same order, each as `change` has it.
  Clusters changed(const std::function<Pointer(const Pointer&)>& change,
                   const Background& background) const;

  /// What it holds, for a checkpoint.
  template <typename Archive>
  void serialize(Archive& archive) {
    archive(chunks_, size_);
  }

 private:
  template <typename Meet>
  static bool meets(const Meet& may_meet, const Entry& entry) {
    if constexpr (std::is_invocable_v<const Meet&, const Entry&>)
      return may_meet(entry);
    else
      return may_meet(entry.reach);
  }
  Place place_of(std::size_t index) const;
  std::size_t home_of(const Reach& reach, std::span<const std::size_t> first) const;

  Chunks chunks_;  ///< none of them empty
  std::size_t size_ = 0;
};

}  // namespace anchord
