// The capital of a gambler who bets on the mean of numbers in [0, 1]. It gives the confidence intervals of
// bounded means (stats/score_mean.h).
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace rcme {

struct CountedNumber {
  double x = 0.0, count = 0.0;  // need not be an integer
};

// log K(m), K(m) = mean over the stakes lambda of prod_i (1 + lambda (x_i - m))^count_i. The stakes are
// `scale` times the given ones, 1 to 16 of them (otherwise std::invalid_argument). Every factor must be above
// zero, as with stakes below 1 / m. The result is bit-identical on every instruction set.
double LogCapital(const std::vector<CountedNumber>& numbers, double m, std::span<const double> stakes,
                  double scale = 1.0);

// LogCapital(...) >= log_capital, but faster.
bool IsCapitalAtLeast(double log_capital, const std::vector<CountedNumber>& numbers, double m,
                      std::span<const double> stakes, double scale = 1.0);

// The greatest excluded m in [0, mean], from below to within a thousandth of `distance`; 0 if there is none.
// Exclusion must hold up to some m < mean and fail from there on. `distance`: step of the search downwards
// from the mean.
double GreatestExcluded(double mean, double distance, const std::function<bool(double)>& is_excluded);

}  // namespace rcme
