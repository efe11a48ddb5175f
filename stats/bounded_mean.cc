#include "stats/bounded_mean.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "stats/betting.h"

namespace rcme {
namespace {

// The best stake for n numbers of standard deviation s is about 5 / (s sqrt(n)) at the confidences of an
// audit: from few numbers to a million. A stake that is off by the square root of two costs a sixth of the
// growth, each further stake its share of the first capital.
constexpr std::array<double, 8> kStakes = {1.0,      1.0 / 2,  1.0 / 4,  1.0 / 8,
                                           1.0 / 16, 1.0 / 32, 1.0 / 64, 1.0 / 128};

// The greatest m in [0, mean] with K_n(m) >= 1 / a; by Jensen's inequality K_n(mean) <= 1.
double LowerBound(const std::vector<CountedNumber>& bins, double mean, double distance, double a) {
  const double needed = -std::log(a);
  return GreatestExcluded(mean, distance, [&](double m) { return LogCapital(bins, m, kStakes) >= needed; });
}

}  // namespace

void BoundedMean::Add(double x) {
  if (!(x >= 0.0 && x <= 1.0)) throw std::invalid_argument("bounded mean: a number outside [0, 1]");
  AddToBin(std::min(static_cast<int>(x * kNumBins), kNumBins - 1), 1.0);
}

void BoundedMean::AddToBin(int bin, double count) {
  n_ += count;
  counts_.at(static_cast<size_t>(bin)) += count;
}

double BoundedMean::mean() const {
  double sum = 0.0;
  for (int b = 0; b < kNumBins; ++b) sum += counts_[static_cast<size_t>(b)] * MiddleOf(b);
  return sum / n_;
}

double BoundedMean::standard_deviation() const {
  const double center = mean();
  double sum = 0.0;
  for (int b = 0; b < kNumBins; ++b) {
    sum += counts_[static_cast<size_t>(b)] * (MiddleOf(b) - center) * (MiddleOf(b) - center);
  }
  return std::sqrt(sum / n_);
}

Interval BoundedMean::Sequence(double confidence) const {
  if (!(n_ > 0.0)) return {0.0, 1.0};
  std::vector<CountedNumber> bins, mirrored;
  for (int b = 0; b < kNumBins; ++b) {
    const double count = counts_[static_cast<size_t>(b)];
    if (count == 0.0) continue;
    bins.push_back({MiddleOf(b), count});
    mirrored.push_back({1.0 - MiddleOf(b), count});
  }
  const double a = 0.5 * (1.0 - confidence), average = mean();
  const double distance = std::max((standard_deviation() + 1.0 / kNumBins) / std::sqrt(n_), 1e-6);
  return {LowerBound(bins, average, distance, a), 1.0 - LowerBound(mirrored, 1.0 - average, distance, a)};
}

}  // namespace rcme
