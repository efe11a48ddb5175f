#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/conform/fit_rule.h"

namespace rcme {

// What new answers say about whether their problems are like those of the calibration.
struct ShiftFinding {
  std::int64_t num_looked_at = 0;             // answers; one of each group where groups are what is new
  double p_value = 1.0;                       // valid at every look
  std::optional<std::int64_t> noticed_after;  // answers, at level kShiftLevel
  std::string feature;                        // that differs most
  double strange_share = 0.0;  // of all answers: those called strange, kStrangeLevel if none differ
};
inline constexpr double kShiftLevel = 0.05;

struct ConformReport {
  ConformRule rule;
  std::string label;                 // of the estimator
  std::vector<JudgedAnswer> judged;  // by cross-validation, or new ones
  std::int64_t num_refusals = 0, num_unscored = 0;
  bool is_check = false;  // of a rule that is there, by new answers
  std::optional<ShiftFinding> shift;
};

ShiftFinding LookForShift(const ConformRule& rule, const std::vector<AnswerRow>& rows);

// Sentences: what the rule promises, what for, and what it needs for more.
std::vector<std::string> DescribePromises(const ConformRule& rule);

// How many answers and groups a promise needs.
std::string DescribeNeeds(const ConformPromise& promise);

std::string ConformAsText(const ConformReport& report);
std::string ConformAsJson(const ConformReport& report);

}  // namespace rcme
