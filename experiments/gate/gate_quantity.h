// The quantities that a gate tests. Each is a number of a trial, smaller is better, and a new version of an
// estimator may not raise its mean by more than a margin.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

enum class GateScale {
  kRate,   // 0 or 1 per trial; a difference of means is one of rates
  kScore,  // in [0, 1]
  kRatio,  // positive; differences are of natural logarithms, clamped to [-1, 1]
};

struct GateQuantity {
  std::string name, doc;
  GateScale scale = GateScale::kRate;
  double usual_margin = 0.0;    // for kRatio: the relative growth allowed, 0.05 for 5 %
  bool needs_same_run = false;  // numbers of two separate runs are not comparable
  // The number of a trial; std::nullopt if the trial has none.
  std::function<std::optional<double>(const TrialRecord&, const FailureBounds&)> of;
  // For a quantity that depends on the stated region: the logarithm of the region's size, which is the
  // geometric mean of its semi-axes; NaN: unknown.
  std::function<double(const TrialRecord&)> log_size = {};

  // New minus old on this scale, in [-1, 1]; 0 for equal numbers, also for two infinite ones.
  double Difference(double of_new, double of_old) const;
  // Convert between a margin in the units of usual_margin and the scale of Difference.
  double ToDifference(double margin) const;
  double FromDifference(double difference) const;
};

// failure, refusal, miscoverage, probability, error, time.
const std::vector<GateQuantity>& GateQuantities();
std::vector<std::string> GateQuantityNames();

// One test of a gate. It compares new minus old version with a margin, or the new version alone with a limit.
struct GateTest {
  GateQuantity quantity;
  double margin = 0.0;  // or the limit, if is_limit
  bool is_limit = false;

  std::string Name() const { return is_limit ? quantity.name + "_at_most" : quantity.name; }
};

// One test for each of the quantities `names`, with its usual margin unless `margins` has a "name=margin" for
// it. Throws InputError if a margin's name is not among `names`, or a margin is not between 0 and 1.
std::vector<GateTest> MakeGateTests(const std::vector<std::string>& names,
                                    const std::vector<std::string>& margins);

}  // namespace rcme
