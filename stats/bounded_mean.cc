#include "stats/bounded_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace rcme {
namespace {

// Stakes. The best one for n numbers of standard deviation s is about 5 / (s sqrt(n)) at the confidences of
// an audit: from few numbers to a million. A stake that is off by the square root of two costs a sixth of the
// growth, each further stake its share of the first capital.
constexpr std::array<double, 8> kStakes = {1.0,      1.0 / 2,  1.0 / 4,  1.0 / 8,
                                           1.0 / 16, 1.0 / 32, 1.0 / 64, 1.0 / 128};

struct Bin {
  double x = 0.0, count = 0.0;
};

// log K_n(m).
double LogCapital(const std::vector<Bin>& bins, double m) {
  std::array<double, kStakes.size()> log_capital{};
  for (size_t j = 0; j < kStakes.size(); ++j) {
    for (const Bin& bin : bins) log_capital[j] += bin.count * std::log1p(kStakes[j] * (bin.x - m));
  }
  const double most = *std::max_element(log_capital.begin(), log_capital.end());
  double sum = 0.0;
  for (const double each : log_capital) sum += std::exp(each - most);
  return most + std::log(sum / kStakes.size());
}

// The greatest m in [0, mean] with K_n(m) >= 1 / a, within a thousandth of `distance` below it; 0 if there is
// no such m. `distance`: the step of the search down from the mean.
double LowerBound(const std::vector<Bin>& bins, double mean, double distance, double a) {
  const double tolerance = 1e-3 * distance;
  const double needed = -std::log(a);
  const auto is_excluded = [&](double m) { return LogCapital(bins, m) >= needed; };
  double inside = mean, outside = mean - distance;  // K(mean) <= 1 by Jensen's inequality
  while (outside > 0.0 && !is_excluded(outside)) inside = outside, outside -= distance;
  if (outside <= 0.0) {
    outside = 0.0;
    if (!is_excluded(0.0)) return 0.0;
  }
  while (inside - outside > tolerance) {
    const double middle = 0.5 * (inside + outside);
    (is_excluded(middle) ? outside : inside) = middle;
  }
  return outside;
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
  std::vector<Bin> bins, mirrored;
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
