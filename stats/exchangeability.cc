#include "stats/exchangeability.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stats/constants.h"

namespace rcme {
namespace {

constexpr double kStake = 0.5;  // e

double Ordered(double x) { return std::isnan(x) ? -kInfinity : x; }

// log(e p^(e-1))
double LogBet(double p) { return std::log(kStake) + (kStake - 1.0) * std::log(p); }

}  // namespace

ExchangeabilityTest::ExchangeabilityTest(std::span<const double> reference, size_t num_features,
                                         const RandomStream& rng)
    : seen_(num_features), log_capital_(kNumBets * num_features, 0.0), rng_(rng) {
  if (num_features == 0 || reference.size() % num_features != 0)
    throw std::invalid_argument("observations need features, each as many");
  greatest_ = 1.0 / static_cast<double>(num_features);
  for (size_t i = 0; i < reference.size(); ++i) seen_[i % num_features].push_back(Ordered(reference[i]));
  for (std::vector<double>& values : seen_) std::ranges::sort(values);
}

void ExchangeabilityTest::Add(std::span<const double> features) {
  if (features.size() != seen_.size()) throw std::invalid_argument("another number of features");
  for (size_t j = 0; j < seen_.size(); ++j) {
    std::vector<double>& seen = seen_[j];
    const double x = Ordered(features[j]);
    const auto [first, last] = std::equal_range(seen.begin(), seen.end(), x);
    const auto num_less = static_cast<double>(first - seen.begin());
    const auto num_equal = static_cast<double>(last - first) + 1.0;  // itself among them
    const auto total = static_cast<double>(seen.size()) + 1.0;
    const double tie = 1.0 - rng_.Uniform();                   // in (0, 1]
    const double rank = (num_less + tie * num_equal) / total;  // uniform on (0, 1]
    const double from_above = std::max(1.0 - rank, 0.5 * 0x1p-53);
    double* log_capital = &log_capital_[kNumBets * j];
    log_capital[0] += LogBet(from_above);
    log_capital[1] += LogBet(rank);
    log_capital[2] += LogBet(2.0 * std::min(rank, from_above));
    seen.insert(last, x);
  }
  ++n_;
  double greatest_sum = 0.0;
  for (size_t first = 0; first < log_capital_.size(); first += kNumBets) {
    double sum = 0.0;
    for (size_t i = first; i < first + kNumBets; ++i) sum += std::exp(std::min(log_capital_[i], 700.0));
    greatest_sum = std::max(greatest_sum, sum);
  }
  greatest_ = std::max(greatest_, std::min(greatest_sum / static_cast<double>(log_capital_.size()), 1e300));
}

size_t ExchangeabilityTest::StrongestFeature() const {
  const auto most = std::ranges::max_element(log_capital_);
  return static_cast<size_t>(most - log_capital_.begin()) / kNumBets;
}

}  // namespace rcme
