// The capital of a gambler who bets on the mean of numbers in [0, 1]: what the intervals of bounded means
// are made of (stats/score_mean.h).
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace rcme {

struct CountedNumber {
  double x = 0.0, count = 0.0;  // not necessarily a whole count
};

// log K(m), K(m) = mean over the stakes lambda of prod_i (1 + lambda (x_i - m))^count_i, the stakes being
// `scale` times those given, 1 to 16 of them (std::invalid_argument). Every factor must be above zero, as all
// are with stakes below 1 / m. The same bits on every instruction set.
double LogCapital(const std::vector<CountedNumber>& numbers, double m, std::span<const double> stakes,
                  double scale = 1.0);

// LogCapital(...) >= log_capital, in less time.
bool IsCapitalAtLeast(double log_capital, const std::vector<CountedNumber>& numbers, double m,
                      std::span<const double> stakes, double scale = 1.0);

// The greatest m in [0, mean] that is excluded, within a thousandth of `distance` below it; 0 if there is no
// such m. Exclusion must be true up to some m < mean and false from there. `distance`: the step of the search
// down from the mean.
double GreatestExcluded(double mean, double distance, const std::function<bool(double)>& is_excluded);

}  // namespace rcme
