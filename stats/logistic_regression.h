// Logistic regression with a penalty on its weights: log odds of an event as a linear function of features.
#pragma once

#include <span>
#include <vector>

namespace rcme {

struct LogisticFit {
  double intercept = 0.0;
  std::vector<double> weights;  // one per feature
};

// Minimises -log likelihood + penalty / 2 * |weights - prior|^2 by Newton's method. `features` holds the
// observations one after the other, each with as many as `prior`. Two added observations of weight 1/2 at the
// mean of the features, one with the event and one without, keep the intercept finite if all outcomes are
// equal. Throws std::invalid_argument for sizes that do not agree, no observation, a penalty not above 0 or
// numbers that are not finite.
LogisticFit FitLogistic(std::span<const double> features, const std::vector<bool>& happened,
                        std::span<const double> prior, double penalty);

}  // namespace rcme
