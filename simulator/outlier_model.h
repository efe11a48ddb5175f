#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "parameters/parameter.h"
#include "simulator/outlier_law.h"

namespace rcme {

// How many matches are wrong, and how they come about.
struct OutlierModel {
  enum class Count { kExact, kBernoulli };

  explicit OutlierModel(double ratio = 0.2);  // uniform mismatches
  explicit OutlierModel(std::shared_ptr<OutlierLaw> outlier_law, double ratio = 0.2)
      : outlier_ratio(ratio), law(std::move(outlier_law)) {}

  double outlier_ratio = 0.2;
  Count count = Count::kExact;
  // q of stats/tilted_binomial.h: the number is drawn as if the ratio were anything between outlier_ratio and
  // this. NaN: it is not tilted. Only for a Bernoulli count; throws InputError otherwise, when it is drawn.
  double tilted_to = std::numeric_limits<double>::quiet_NaN();
  std::shared_ptr<OutlierLaw> law;

  // The number of wrong matches of a trial, and the trial's weight: the probability of that number under the
  // model, divided by that under the law it was drawn from. It is 1 unless the number is tilted.
  struct Drawn {
    int num_outliers = 0;
    double weight = 1.0;
  };
  Drawn DrawCount(int num_matches, RandomStream& rng) const;
};
// Those of the law included.
std::vector<Parameter> Parameters(OutlierModel& outliers);

}  // namespace rcme
