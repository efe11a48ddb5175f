#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

// The median of a stream of numbers with its distribution-free interval (stats/accuracy.h), in memory that
// depends on their range and not on how many there are: numbers of one sign that agree in their exponent and
// their first eight binary digits share a cell, which keeps its count, its least and its greatest.
class StreamMedian {
 public:
  // May be infinite. Throws std::invalid_argument on NaN.
  void Add(double x);
  // As if the other's numbers had been added here.
  void Merge(const StreamMedian& other);

  std::int64_t n() const { return n_; }
  // The ceil(n / 2)-th smallest, or the least number of its cell: at most 0.4 % nearer to zero. NaN at n = 0.
  double median() const;
  // At least `confidence`, for independent numbers of one law, their number fixed beforehand: the ends are
  // those of the cells of the order statistics, so rounding only widens it. An end is infinite where no order
  // statistic is far enough out.
  Interval interval(double confidence = 0.95) const;

  // How many are not above `x`, or in its cell.
  std::int64_t CountUpTo(double x) const;
  // From the quantile of level `from` to that of level `to`, the ends those of their cells; infinite for a
  // level beyond (0, 1). NaN without numbers.
  Interval IntervalOfQuantiles(double from, double to) const;

  // All of it: "count:least:greatest", in the order of the numbers, separated by spaces.
  std::string Text() const;
  // Throws std::invalid_argument for any other text.
  static StreamMedian FromText(const std::string& text);

 private:
  struct Cell {
    double number = 0.0;  // cut off after eight digits
    std::int64_t count = 0;
    double least = 0.0, greatest = 0.0;
  };
  const Cell& FindCell(std::int64_t rank) const;  // of the rank-th smallest, from 1
  // The cell of this number; a new one has these ends and no count.
  Cell& FindOrMakeCell(double number, double least, double greatest);

  std::vector<Cell> cells_;  // ascending by number; looking them up dominates the time of a large summary
  std::int64_t n_ = 0;
};

}  // namespace rcme
