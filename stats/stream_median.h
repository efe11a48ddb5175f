#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

// The median of a stream of numbers with its distribution-free interval (stats/measured_quantile.h). Memory
// depends on the range of the numbers, not on their count: numbers of one sign that agree in their exponent
// and their first eight binary digits share a cell, which stores its count, minimum and maximum.
class StreamMedian {
 public:
  // May be infinite. Throws std::invalid_argument on NaN.
  void Add(double x);
  // Adds the other's numbers.
  void Merge(const StreamMedian& other);

  std::int64_t n() const { return n_; }
  // The ceil(n / 2)-th smallest number, or the least of its cell: at most 0.4 % nearer to zero. NaN at n = 0.
  double median() const;
  // Covers with at least `confidence` for independent numbers of one law, their count fixed beforehand. The
  // ends are those of the order statistics' cells, so rounding only widens the interval. An end is infinite
  // if no order statistic is far enough out.
  Interval interval(double confidence = 0.95) const;

  // The number of values that are at most `x` or in its cell.
  std::int64_t CountUpTo(double x) const;
  // From the quantile of level `from` to that of level `to`, at the ends of their cells; infinite for a level
  // outside of (0, 1). NaN without numbers.
  Interval IntervalOfQuantiles(double from, double to) const;

  // All cells as "count:least:greatest", in ascending order, separated by spaces.
  std::string Text() const;
  // Throws std::invalid_argument for any other text.
  static StreamMedian FromText(const std::string& text);

 private:
  struct Cell {
    double number = 0.0;  // truncated to eight digits
    std::int64_t count = 0;
    double least = 0.0, greatest = 0.0;
  };
  const Cell& FindCell(std::int64_t rank) const;  // cell of the rank-th smallest, counted from 1
  // The cell of this number; a new one has these ends and no count.
  Cell& FindOrMakeCell(double number, double least, double greatest);

  std::vector<Cell> cells_;  // ascending by number; looking them up dominates the time of a large summary
  std::int64_t n_ = 0;
};

}  // namespace rcme
