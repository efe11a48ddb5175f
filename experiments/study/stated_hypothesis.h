// What a study states beforehand that its run will show. In a study file:
//
//   hypotheses:
//     - {quantity: failure, estimator: rcme, against: standard, direction: lower, margin: 0.02}
//     - {quantity: nees_coverage, estimator: rcme, at_least: 0.93, where: {outlier_ratio: 0.4}}
//
// Each is of all conditions of the study, or of those with the levels that `where` names.
#pragma once

#include <string>
#include <vector>

#include "experiments/core/files/yaml_input.h"
#include "experiments/data/settings.h"

namespace rcme {

inline constexpr size_t kMaxHypotheses = 100;

// Of the value v of a quantity of an estimator, or of the difference d, that of the estimator less that of
// `against` on the same trials; with the bound b:
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
  std::string against;  // empty: of the estimator alone
  StatedDirection direction = StatedDirection::kAtLeast;
  double bound = 0.0;  // what v is compared with, or the margin of d
  Settings where;      // levels of factors; empty: all conditions
};

// The quantities that a hypothesis may be of: rates and scores of the summary, which have intervals.
const std::vector<std::string>& StatableQuantities();

// What a hypothesis may name.
struct StatableNames {
  std::vector<std::string> estimators;                                    // labels
  std::vector<std::pair<std::string, std::vector<std::string>>> factors;  // with their levels
};

// Throws InputError with file, line, key and what is allowed.
std::vector<StatedHypothesis> ReadHypotheses(const Place& place, const YAML::Node& node,
                                             const StatableNames& names);

// The list as ReadHypotheses takes it.
void WriteHypotheses(const std::vector<StatedHypothesis>& hypotheses, YAML::Emitter* out);

// "failure of rcme is lower than that of standard by more than 0.02 where outlier_ratio = 0.4".
std::string Describe(const StatedHypothesis& hypothesis);

}  // namespace rcme
