#include "anchoring/clusters.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "anchoring/belief.h"
#include "core/scratch.h"

namespace anchord {
namespace {

/// Clusters in a chunk, at most: a frame copies the chunks that it changes, and looks at the reach
/// of every chunk; with this many either costs little.
constexpr std::size_t kMost = 64;

using Entries = PoolVector<Clusters::Entry>;

double centre(const Reach& reach, int axis) {
  return 0.5 * (reach.axis[axis].low + reach.axis[axis].high);
}

Reach of_all(const Entries& entries) {
  Reach reach;
  for (const Clusters::Entry& entry : entries) reach.include(entry.reach);
  return reach;
}

/// Entries as one chunk, or as many as it takes.
void make_chunks(Entries entries, Clusters::Chunks& out) {
  if (entries.empty()) return;
  const Reach reach = of_all(entries);
  if (entries.size() <= kMost) {
    out.push_back(make_pooled<const Clusters::Chunk>(Clusters::Chunk{std::move(entries), reach}));
    return;
  }
  const auto length = [&](int axis) { return reach.axis[axis].high - reach.axis[axis].low; };
  const int axis = length(1) > length(0) ? 1 : 0;
  std::stable_sort(entries.begin(), entries.end(), [axis](const auto& a, const auto& b) {
    return centre(a.reach, axis) < centre(b.reach, axis);
  });
  const auto middle = entries.begin() + static_cast<std::ptrdiff_t>(entries.size() / 2);
  make_chunks(Entries(entries.begin(), middle), out);
  make_chunks(Entries(middle, entries.end()), out);
}

/// How far the centre of one reach is from the means of another, m^2.
double distance2(const Reach& from, const Reach& to) {
  double sum = 0;
  for (int i = 0; i < 2; ++i) {
    const double at = centre(from, i);
    const double outside = std::max({to.axis[i].low - at, at - to.axis[i].high, 0.0});
    sum += outside * outside;
  }
  return sum;
}

}  // namespace

const Clusters::Pointer& Clusters::operator[](std::size_t index) const {
  const Place at = place_of(index);
  return chunks_[at.chunk]->entries[at.entry].cluster;
}

Clusters::Place Clusters::place_of(std::size_t index) const {
  std::size_t c = 0;
  for (; index >= chunks_[c]->entries.size(); ++c) index -= chunks_[c]->entries.size();
  return {c, index};
}

/// The chunk that something belongs to: one of the `first` that it lies in, else the nearest.
std::size_t Clusters::home_of(const Reach& reach, std::span<const std::size_t> first) const {
  for (const std::size_t c : first)
    if (distance2(reach, chunks_[c]->reach) == 0) return c;
  std::size_t home = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < chunks_.size() && least > 0; ++c)
    if (const double d2 = distance2(reach, chunks_[c]->reach); d2 < least) least = d2, home = c;
  return home;
}

void Clusters::exchange(std::span<const Place> gone, std::span<const Pointer> come,
                        const Background& background) {
  const Scratch scratch;
  size_ = size_ + come.size() - gone.size();
  ScratchVector<std::size_t> changed;  // chunks, ascending
  for (const Place& at : gone)
    if (changed.empty() || changed.back() != at.chunk) changed.push_back(at.chunk);
  struct Added {
    std::size_t home, order;
    Entry entry;
    bool operator<(const Added& o) const {
      return std::tie(home, order) < std::tie(o.home, o.order);
    }
  };
  ScratchVector<Added> added;
  for (const Pointer& cluster : come) {
    Entry entry{cluster, Reach::of(*cluster, background)};
    const std::size_t home = home_of(entry.reach, changed);
    added.push_back({home, added.size(), std::move(entry)});
  }
  std::sort(added.begin(), added.end());
  for (const Added& one : added) changed.push_back(one.home);
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());

  Chunks chunks;
  chunks.reserve(chunks_.size() + added.size() / kMost + 2 * changed.size());
  auto out = gone.begin();
  auto in = added.begin();
  std::size_t kept = 0;  // chunks up to here are in place
  const auto keep_until = [&](std::size_t end) {
    for (; kept < std::min(end, chunks_.size()); ++kept) chunks.push_back(std::move(chunks_[kept]));
  };
  for (const std::size_t c : changed) {
    keep_until(c);
    Entries entries;
    entries.reserve(kMost);
    if (c < chunks_.size()) {
      const Entries& old = chunks_[c]->entries;
      for (std::size_t e = 0; e < old.size(); ++e) {
        if (out != gone.end() && out->chunk == c && out->entry == e)
          ++out;
        else
          entries.push_back(old[e]);
      }
    }
    for (; in != added.end() && in->home == c; ++in) entries.push_back(std::move(in->entry));
    make_chunks(std::move(entries), chunks);
    kept = c + 1;
  }
  keep_until(chunks_.size());
  chunks_ = std::move(chunks);
}

void Clusters::add(Pointer cluster, const Background& background) {
  exchange({}, {&cluster, 1}, background);
}

void Clusters::erase(std::size_t index) {
  const Place at = place_of(index);
  Entries entries = chunks_[at.chunk]->entries;
  entries.erase(entries.begin() + static_cast<std::ptrdiff_t>(at.entry));
  const auto chunk = chunks_.begin() + static_cast<std::ptrdiff_t>(at.chunk);
  if (entries.empty())
    chunks_.erase(chunk);
  else
    *chunk = make_pooled<const Chunk>(Chunk{entries, of_all(entries)});
  --size_;
}

Clusters Clusters::changed(const std::function<Pointer(const Pointer&)>& change,
                           const Background& background) const {
  Clusters out;
  for (const auto& chunk : chunks_) {
    Entries entries;
    entries.reserve(kMost);
    for (const Entry& entry : chunk->entries) {
      Pointer cluster = change(entry.cluster);
      const Reach reach = Reach::of(*cluster, background);
      entries.push_back({std::move(cluster), reach});
    }
    const Reach reach = of_all(entries);
    out.chunks_.push_back(make_pooled<const Chunk>(Chunk{std::move(entries), reach}));
  }
  out.size_ = size_;
  return out;
}

void Clusters::replace(std::size_t index, Pointer cluster, const Background& background) {
  const Place at = place_of(index);
  Entries entries = chunks_[at.chunk]->entries;
  entries[at.entry] = {cluster, Reach::of(*cluster, background)};
  chunks_[at.chunk] = make_pooled<const Chunk>(Chunk{entries, of_all(entries)});
}

}  // namespace anchord
