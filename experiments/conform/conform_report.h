// A calibration, or the check of an earlier one by new problems: from the answers of a plan to a report.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/conform/calibration_work.h"
#include "experiments/conform/fit_rule.h"

namespace rcme {

// What new answers say about whether their problems are like those of the calibration.
struct ShiftFinding {
  std::int64_t num_looked_at = 0;  // answers, in random order; one of each group where groups are new
  double p_value = 1.0;            // valid at every look
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

// Of the plan's one estimator. `models`: as FitConformRule; may be null. Throws InputError as that.
ConformReport CalibrateConform(const StudyPlan& plan, NewProblem new_problem, const ConformPromise& promise,
                               const ConformRule* models, const AnswerRows& answers);
// Of a rule whose estimator is the plan's.
ConformReport CheckConform(const StudyPlan& plan, const ConformRule& rule, const AnswerRows& answers);

}  // namespace rcme
