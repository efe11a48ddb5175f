// Are new observations like those of before? A conformal test martingale (Vovk, Nouretdinov & Gammerman
// 2003), valid however often it is looked at.
//
// Of each feature, the p-value of a new observation among all of before, ties broken at random, is uniform
// and independent of the p-values before it as long as all are exchangeable; the observation then joins those
// of before. A gambler who bets that p-values are small has the capital prod of e p^(e-1), which has mean 1.
// Of every feature there are gamblers for great values, for small ones and for both ends, each with e = .5,
// and the mean of their capitals is a martingale too. So
//   P(the mean capital ever reaches 1 / a | exchangeable) <= a      (Ville 1939).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "stats/random.h"

namespace rcme {

class ExchangeabilityTest {
 public:
  // `reference` holds the observations one after the other, each with `num_features` numbers; NaN is a value
  // of its own, the least. `rng` breaks ties. Throws std::invalid_argument for no feature, or a last
  // observation that is not whole.
  ExchangeabilityTest(std::span<const double> reference, size_t num_features, const RandomStream& rng);

  // Throws std::invalid_argument for another number of features.
  void Add(std::span<const double> features);

  // The mean capital now, and its greatest so far: at least 1 / a with probability at most a.
  double capital() const { return capital_; }
  double greatest_capital() const { return greatest_; }
  // P-value at any look.
  double PValue() const { return greatest_ > 1.0 ? 1.0 / greatest_ : 1.0; }
  // The feature whose gamblers have won most.
  size_t StrongestFeature() const;
  size_t n() const { return n_; }  // observations added

 private:
  static constexpr size_t kNumBets = 3;

  std::vector<std::vector<double>> seen_;  // per feature, rising
  std::vector<double> log_capital_;        // per feature and bet
  RandomStream rng_;
  double capital_ = 1.0, greatest_ = 1.0;
  size_t n_ = 0;
};

}  // namespace rcme
