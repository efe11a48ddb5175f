#include "stats/stream_median.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "stats/constants.h"
#include "stats/measured_quantile.h"

namespace rcme {
namespace {

// Truncated towards zero to the first eight of the 52 binary digits after the leading one.
double CutOff(double x) {
  constexpr std::uint64_t kDroppedBits = (std::uint64_t{1} << (52 - 8)) - 1;
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & ~kDroppedBits);
}

}  // namespace

void StreamMedian::Add(double x) {
  if (std::isnan(x)) throw std::invalid_argument("median: a value is NaN");
  Cell& cell = FindOrMakeCell(CutOff(x), x, x);
  ++cell.count;
  cell.least = std::min(cell.least, x);
  cell.greatest = std::max(cell.greatest, x);
  ++n_;
}

StreamMedian::Cell& StreamMedian::FindOrMakeCell(double number, double least, double greatest) {
  const auto at = std::ranges::lower_bound(cells_, number, {}, &Cell::number);
  if (at != cells_.end() && at->number == number) return *at;
  return *cells_.insert(at, {number, 0, least, greatest});
}

void StreamMedian::Merge(const StreamMedian& other) {
  for (const Cell& cell : other.cells_) {
    Cell& here = FindOrMakeCell(cell.number, cell.least, cell.greatest);
    here.count += cell.count;
    here.least = std::min(here.least, cell.least);
    here.greatest = std::max(here.greatest, cell.greatest);
  }
  n_ += other.n_;
}

std::string StreamMedian::Text() const {
  std::string text;
  char cell_text[100];
  for (const Cell& cell : cells_) {
    std::snprintf(cell_text, sizeof(cell_text), "%s%lld:%a:%a", text.empty() ? "" : " ",
                  static_cast<long long>(cell.count), cell.least, cell.greatest);
    text += cell_text;
  }
  return text;
}

StreamMedian StreamMedian::FromText(const std::string& text) {
  StreamMedian median;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    Cell cell;
    long long count = 0;
    int length = 0;
    const int num_read =
        std::sscanf(word.c_str(), "%lld:%la:%la%n", &count, &cell.least, &cell.greatest, &length);
    cell.count = count;
    const bool is_cell = num_read == 3 && static_cast<size_t>(length) == word.size() && count > 0 &&
                         cell.least <= cell.greatest && CutOff(cell.least) == CutOff(cell.greatest);
    const bool is_countable = count <= std::numeric_limits<std::int64_t>::max() - median.n_;
    cell.number = CutOff(cell.least);
    const bool is_next = median.cells_.empty() || cell.number > median.cells_.back().number;
    if (!is_cell || !is_countable || !is_next) throw std::invalid_argument("median: not a cell: " + word);
    median.cells_.push_back(cell);
    median.n_ += count;
  }
  return median;
}

const StreamMedian::Cell& StreamMedian::FindCell(std::int64_t rank) const {
  auto at = cells_.begin();
  for (std::int64_t below = at->count; below < rank; below += at->count) ++at;
  return *at;
}

std::int64_t StreamMedian::CountUpTo(double x) const {
  std::int64_t count = 0;
  const double cut_off = CutOff(x);
  for (const Cell& cell : cells_) {
    if (cell.least <= x || cell.number == cut_off) count += cell.count;
  }
  return count;
}

Interval StreamMedian::IntervalOfQuantiles(double from, double to) const {
  if (n_ == 0) return {kNaN, kNaN};
  const double n = static_cast<double>(n_);
  return {from <= 0.0 ? -kInfinity : FindCell(static_cast<std::int64_t>(std::ceil(from * n))).least,
          to >= 1.0 ? kInfinity : FindCell(static_cast<std::int64_t>(std::floor(to * n)) + 1).greatest};
}

double StreamMedian::median() const {
  return n_ > 0 ? FindCell((n_ + 1) / 2).least : std::numeric_limits<double>::quiet_NaN();
}

Interval StreamMedian::interval(double confidence) const {
  if (n_ == 0) return {-kInfinity, kInfinity};
  const RankInterval ranks = QuantileRanks(n_, 0.5, confidence);
  return {ranks.lower < 1 ? -kInfinity : FindCell(ranks.lower).least,
          ranks.upper > n_ ? kInfinity : FindCell(ranks.upper).greatest};
}

}  // namespace rcme
