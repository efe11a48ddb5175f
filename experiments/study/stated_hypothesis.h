// Hypotheses that a study states before its run. In a study file:
//
//   hypotheses:
//     - {quantity: failure, estimator: rcme, against: standard, direction: lower, margin: 0.02}
//     - {quantity: nees_coverage, estimator: rcme, at_least: 0.93, where: {outlier_ratio: 0.4}}
//
// Each hypothesis concerns all conditions of the study, or those with the levels in `where`.
#pragma once

#include <string>
#include <vector>

#include "experiments/core/files/yaml_input.h"
#include "experiments/data/settings.h"

namespace rcme {

inline constexpr size_t kMaxHypotheses = 100;

// A hypothesis compares the bound b with the value v of a quantity of an estimator, or with the difference
// d: the estimator's value minus that of `against` on the same trials.
enum class StatedDirection {
  kAtLeast,    // v >= b
  kAtMost,     // v <= b
  kLower,      // d < -b
  kHigher,     // d > b
  kNotLower,   // d > -b
  kNotHigher,  // d < b
};

struct StatedHypothesis {
  std::string quantity, estimator;
  std::string against;  // empty: the hypothesis is about the estimator alone
  StatedDirection direction = StatedDirection::kAtLeast;
  double bound = 0.0;  // bound of v, or margin of d
  Settings where;      // levels of factors; empty: all conditions
};

// Returns the quantities allowed in a hypothesis: rates and scores of the summary, which have intervals.
const std::vector<std::string>& StatableQuantities();

// The names that a hypothesis may refer to.
struct StatableNames {
  std::vector<std::string> estimators;                                    // labels
  std::vector<std::pair<std::string, std::vector<std::string>>> factors;  // name and levels of each factor
};

// Reads the list of hypotheses. Throws InputError with file, line, key and what is allowed.
std::vector<StatedHypothesis> ReadHypotheses(const Place& place, const YAML::Node& node,
                                             const StatableNames& names);

// Writes the list as ReadHypotheses reads it.
void WriteHypotheses(const std::vector<StatedHypothesis>& hypotheses, YAML::Emitter* out);

// "failure of rcme is lower than that of standard by more than 0.02 where outlier_ratio = 0.4".
std::string Describe(const StatedHypothesis& hypothesis);

}  // namespace rcme
