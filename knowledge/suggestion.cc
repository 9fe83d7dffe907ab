#include "knowledge/suggestion.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace anchord {
namespace {

constexpr std::size_t kMostCompared = 64;  // letters; longer names get no suggestion
constexpr std::size_t kMostListed = 12;

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

/// Edit distance with swaps of neighbours (optimal string alignment).
std::size_t slips(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
          lower(a[i - 2]) == lower(b[j - 1])) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
    before_last = last;
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& known) {
  std::string best;
  std::size_t best_slips = kMostCompared;
  for (const std::string& candidate : known) {
    const std::size_t length = std::max(name.size(), candidate.size());
    if (length > kMostCompared) continue;
    const std::size_t distance = slips(name, candidate);
    if (distance <= std::max<std::size_t>(1, length / 3) && distance < best_slips) {
      best = candidate;
      best_slips = distance;
    }
  }
  return best;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  if (known.empty()) return "there are none";
  const std::string nearest = nearest_name(name, known);
  if (!nearest.empty()) return "did you mean \"" + nearest + "\"?";
  std::string list = "there are: ";
  for (std::size_t i = 0; i < known.size() && i < kMostListed; ++i) {
    list += (i ? ", \"" : "\"") + known[i] + "\"";
  }
  return known.size() > kMostListed ? list + ", ..." : list;
}

}  // namespace anchord
