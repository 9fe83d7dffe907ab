#pragma once

#include <boost/container/small_vector.hpp>
#include <vector>

namespace anchord {

/// One flag for each detection.
using RowFlags = boost::container::small_vector<char, 16>;

/// Which leaf each detection is given to, at most one detection to a leaf, or to none: the
/// assignment of least cost, with the dual prices that prove it.
///
/// Costs are a dense matrix, one row per detection: cost[z * (leaves + 1) + l]; the last entry of a
/// row is the cost of no leaf; infinity forbids. Solved by shortest augmenting paths on reduced
/// costs (Jonker and Volgenant 1987). A solution that loses one pair goes on from its prices: one
/// path, which is what ranking needs (Miller, Stone, Cox 1997). A value: copies share nothing.
class Assignment {
 public:
  Assignment(int detections, int leaves);

  /// The optimum of these costs. Every row must have a finite entry that no other row can take
  /// (its last one).
  void solve(const std::vector<double>& cost);

  /// Goes on to the optimum after the pair (z, choice(z)) and possibly others have been made
  /// infinite in row z of `cost`. Rows with a flag in `fixed` keep theirs. False if there is no
  /// assignment left; the object is then spent.
  bool reassign(int z, const std::vector<double>& cost, const RowFlags& fixed);

  /// What detection z is given to: a leaf, or leaves() for none.
  int choice(int z) const { return column_of_[z] < leaves_ ? column_of_[z] : leaves_; }
  int detections() const { return detections_; }
  int leaves() const { return leaves_; }

  double cost(const std::vector<double>& cost) const;

  /// A lower bound on what it costs if z may not keep its choice: the least reduced cost among the
  /// row's other entries.
  double least_loss(int z, const std::vector<double>& cost) const;

 private:
  static constexpr int kFree = -1;
  int columns() const { return leaves_ + detections_; }
  double reduced(int z, int column, const std::vector<double>& cost) const;
  bool augment(int z, int target, const std::vector<double>& cost, const RowFlags* fixed);

  int detections_, leaves_;
  // Columns: the leaves, then each detection's own "none".
  boost::container::small_vector<int, 8> column_of_, row_of_;
  boost::container::small_vector<double, 8> row_price_, column_price_;
  double free_price_ = 0;  // of whoever holds the columns that no detection has
};

}  // namespace anchord
