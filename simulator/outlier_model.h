#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "parameters/parameter.h"
#include "simulator/outlier_law.h"

namespace rcme {

// The number of wrong matches and their law.
struct OutlierModel {
  enum class Count { kExact, kBernoulli };

  explicit OutlierModel(double ratio = 0.2);  // uniform mismatches
  explicit OutlierModel(std::shared_ptr<OutlierLaw> outlier_law, double ratio = 0.2)
      : outlier_ratio(ratio), law(std::move(outlier_law)) {}

  double outlier_ratio = 0.2;
  Count count = Count::kExact;
  // q of stats/tilted_binomial.h: the number is drawn with a ratio uniform between outlier_ratio and this.
  // NaN: no tilting. Only for a Bernoulli count; otherwise DrawCount throws InputError.
  double tilted_to = std::numeric_limits<double>::quiet_NaN();
  std::shared_ptr<OutlierLaw> law;

  // The number of wrong matches of a trial, and the trial's weight: the probability of this number under the
  // model divided by that under the law it was drawn from. It is 1 without tilting.
  struct Drawn {
    int num_outliers = 0;
    double weight = 1.0;
  };
  Drawn DrawCount(int num_matches, RandomStream& rng) const;
};
// Includes the parameters of the law.
std::vector<Parameter> Parameters(OutlierModel& outliers);

}  // namespace rcme
