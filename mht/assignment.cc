#include "mht/assignment.h"

#include <algorithm>
#include <limits>

namespace anchord {
namespace {
constexpr double kInfinite = std::numeric_limits<double>::infinity();
}

Assignment::Assignment(int detections, int leaves)
    : detections_(detections),
      leaves_(leaves),
      column_of_(detections, kFree),
      row_of_(leaves + detections, kFree),
      row_price_(detections, 0.0),
      column_price_(leaves + detections, 0.0) {}

double Assignment::reduced(int z, int column, const std::vector<double>& cost) const {
  if (column >= leaves_ && column != leaves_ + z) return kInfinite;
  const int entry = column < leaves_ ? column : leaves_;
  return cost[z * (leaves_ + 1) + entry] - row_price_[z] - column_price_[column];
}

void Assignment::solve(const std::vector<double>& cost) {
  *this = Assignment(detections_, leaves_);
  for (int z = 0; z < detections_; ++z) {
    double least = kInfinite;
    for (int l = 0; l <= leaves_; ++l) least = std::min(least, cost[z * (leaves_ + 1) + l]);
    row_price_[z] = least;
  }
  for (int z = 0; z < detections_; ++z) augment(z, kFree, cost, nullptr);
}

bool Assignment::reassign(int z, const std::vector<double>& cost, const RowFlags& fixed) {
  const int left = column_of_[z];
  column_of_[z] = kFree;
  row_of_[left] = kFree;
  return augment(z, left, cost, &fixed);
}

/// Dijkstra from row z over reduced costs. Without a target the path ends in the nearest free
/// column. With one it must end there: the column that z has just left, while the other free
/// columns count as held by one more row ("nobody") that takes any column at cost 0.
bool Assignment::augment(int z, int target, const std::vector<double>& cost,
                         const RowFlags* fixed) {
  constexpr int kNobody = -2, kStart = -3;
  const int n = columns();
  boost::container::small_vector<double, 16> distance(n, kInfinite);
  boost::container::small_vector<int, 16> from(n, kStart);  // the row (or nobody) that reached it
  boost::container::small_vector<char, 16> done(n, 0);
  double nobody_distance = kInfinite;
  int nobody_column = kFree;

  if (fixed)
    for (int r = 0; r < detections_; ++r)
      if ((*fixed)[r]) done[column_of_[r]] = 1;  // out of the graph

  const auto relax_row = [&](int row, double base) {
    const double* row_cost = &cost[row * (leaves_ + 1)];
    for (int l = 0; l <= leaves_; ++l) {
      const int column = l < leaves_ ? l : leaves_ + row;
      if (done[column]) continue;
      const double d = base + (row_cost[l] - row_price_[row] - column_price_[column]);
      if (d < distance[column]) distance[column] = d, from[column] = row;
    }
  };
  relax_row(z, 0);
  int end = kFree;
  boost::container::small_vector<int, 16> visited;
  while (true) {
    int nearest = kFree;
    for (int c = 0; c < n; ++c)
      if (!done[c] && distance[c] < kInfinite &&
          (nearest == kFree || distance[c] < distance[nearest]))
        nearest = c;
    if (nearest == kFree) return false;
    const bool free = row_of_[nearest] == kFree;
    if (free && (target == kFree || nearest == target)) {
      end = nearest;
      break;
    }
    done[nearest] = 1;
    visited.push_back(nearest);
    if (!free) {
      relax_row(row_of_[nearest], distance[nearest]);
    } else if (nobody_column == kFree) {
      nobody_column = nearest;
      nobody_distance = distance[nearest];
      for (int c = 0; c < n; ++c) {
        if (done[c]) continue;
        const double d = nobody_distance + (0 - free_price_ - column_price_[c]);
        if (d < distance[c]) distance[c] = d, from[c] = kNobody;
      }
    }
  }

  const double length = distance[end];
  row_price_[z] += length;
  for (int c : visited) {
    column_price_[c] -= length - distance[c];
    if (row_of_[c] != kFree) row_price_[row_of_[c]] += length - distance[c];
  }
  if (nobody_column != kFree) free_price_ += length - nobody_distance;

  for (int column = end;;) {
    const int row = from[column];
    if (row == kNobody) {  // nobody takes this column and gives up the one it came through
      row_of_[column] = kFree;
      column = nobody_column;
      continue;
    }
    const int next = column_of_[row];
    column_of_[row] = column;
    row_of_[column] = row;
    if (row == z) break;
    column = next;
  }
  return true;
}

double Assignment::cost(const std::vector<double>& cost) const {
  double sum = 0;
  for (int z = 0; z < detections_; ++z) sum += cost[z * (leaves_ + 1) + choice(z)];
  return sum;
}

double Assignment::least_loss(int z, const std::vector<double>& cost) const {
  double least = kInfinite;
  for (int l = 0; l <= leaves_; ++l) {
    if (l == choice(z)) continue;
    least = std::min(least, reduced(z, l < leaves_ ? l : leaves_ + z, cost));
  }
  return std::max(least, 0.0);
}

}  // namespace anchord
