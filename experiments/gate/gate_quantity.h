// What a gate judges: numbers of a trial that a new version of an estimator may not raise by more than a
// margin.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

enum class GateScale {
  kRate,   // 0 or 1 of a trial: differences are of rates
  kScore,  // in [0, 1]
  kRatio,  // positive: differences are of logarithms, cut off at e times as much and as little
};

// Of each the less is the better.
struct GateQuantity {
  std::string name, doc;
  GateScale scale = GateScale::kRate;
  double usual_margin = 0.0;    // in the units of a margin: of kRatio the share by which a number may grow
  bool needs_same_run = false;  // numbers of two runs cannot be compared
  // What a trial gives; nothing where it says nothing about the estimator.
  std::function<std::optional<double>(const TrialRecord&, const FailureBounds&)> of;
  // Of what regions decide: the logarithm of their size, the geometric mean of the semi-axes; NaN: unknown.
  std::function<double(const TrialRecord&)> log_size = {};

  // Of a new and an old number, in [-1, 1]; 0 for equal ones, infinite ones too.
  double Difference(double of_new, double of_old) const;
  // A margin on the scale of these differences, and a difference as people read it: of kRatio a share.
  double ToDifference(double margin) const;
  double FromDifference(double difference) const;
};

// failure, refusal, miscoverage, probability, error, time.
const std::vector<GateQuantity>& GateQuantities();
std::vector<std::string> GateQuantityNames();

// One thing that a gate tests: a quantity of the new version less that of the old one against a margin, or of
// the new version alone against a limit.
struct GateTest {
  GateQuantity quantity;
  double margin = 0.0;  // or the limit
  bool is_limit = false;

  std::string Name() const { return is_limit ? quantity.name + "_at_most" : quantity.name; }
};

// The tests of these quantities with their usual margins, or those of "name=margin". Throws InputError for a
// name that is not among the quantities and a margin that is not allowed.
std::vector<GateTest> MakeGateTests(const std::vector<std::string>& names,
                                    const std::vector<std::string>& margins);

}  // namespace rcme
