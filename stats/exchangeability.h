// A test whether new observations are exchangeable with earlier ones. A conformal test martingale (Vovk,
// Nouretdinov & Gammerman 2003), valid at any number of looks.
//
// For each feature compute the p-value of a new observation among all earlier ones, with ties broken at
// random. Under exchangeability it is uniform and independent of the earlier p-values of this feature. The
// observation then joins the earlier ones. A gambler who bets that p-values are small has the capital prod of
// e p^(e-1), of mean 1. Each feature has three gamblers, for large values, small values and both ends, each
// with e = .5. The mean of a feature's three capitals is a martingale given its earlier p-values, so
//   P(the mean capital of a feature ever reaches k / a | exchangeable) <= a / k      (Ville 1939)
// and none of k features reaches k / a with probability at least 1 - a (Bonferroni). Capitals of different
// features may not be averaged: the p-values of one feature may tell something of the next one of another,
// so that the average is no martingale.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "stats/random.h"

namespace rcme {

class ExchangeabilityTest {
 public:
  // `reference` holds the observations one after the other, each with `num_features` numbers; NaN is a value
  // of its own, the smallest. `rng` breaks ties. Throws std::invalid_argument for zero features, or an
  // incomplete last observation.
  ExchangeabilityTest(std::span<const double> reference, size_t num_features, const RandomStream& rng);

  // Throws std::invalid_argument for a different number of features.
  void Add(std::span<const double> features);

  // Anytime-valid p-value.
  double PValue() const { return greatest_ > 1.0 ? 1.0 / greatest_ : 1.0; }
  // The feature whose gamblers have won most.
  size_t StrongestFeature() const;
  size_t n() const { return n_; }  // observations added

 private:
  static constexpr size_t kNumBets = 3;

  std::vector<std::vector<double>> seen_;  // per feature, ascending
  std::vector<double> log_capital_;        // per feature and bet
  RandomStream rng_;
  // The greatest mean capital of a feature so far, divided by the number of features. It reaches 1 / a with
  // probability at most a.
  double greatest_;
  size_t n_ = 0;
};

}  // namespace rcme
