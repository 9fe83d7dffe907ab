#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace anchord::bench {

/// How long things took.
class Times {
 public:
  void add(double ms) { ms_.push_back(ms); }
  std::size_t count() const { return ms_.size(); }
  /// The smallest value that at least the share `p` of all are not above (nearest rank), ms; 0 if
  /// there are none.
  double quantile_ms(double p) const;
  double median_ms() const { return quantile_ms(0.5); }
  double p99_ms() const { return quantile_ms(0.99); }
  double max_ms() const { return quantile_ms(1); }

 private:
  std::vector<double> ms_;
};

/// Measures from its making on: by the wall, and on the processor by this thread alone, which
/// leaves out what other programs took.
class Stopwatch {
 public:
  Stopwatch();
  double wall_ms() const;
  double cpu_ms() const;

 private:
  std::chrono::steady_clock::time_point wall_;
  double cpu_ms_;
};

/// A row of a Markdown table on standard output; a head is one with a rule below it.
void print_row(const std::vector<std::string>& cells);
void print_head(const std::vector<std::string>& cells);

/// A number with so many digits after the point.
std::string fixed(double value, int digits);

}  // namespace anchord::bench
