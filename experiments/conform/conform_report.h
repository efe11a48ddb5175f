// A calibration, or the check of an earlier one by new problems: from the answers of a plan to a report.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/conform/calibration_work.h"
#include "experiments/conform/cross_validate.h"
#include "experiments/conform/set_promises.h"
#include "experiments/conform/test_promises.h"

namespace rcme {

// What new answers say about whether their problems are like those of the calibration.
struct ShiftFinding {
  std::int64_t num_looked_at = 0;             // answers in random order, one of each group
  bool could_notice = false;                  // so many that the greatest shift would be noticed
  double p_value = 1.0;                       // valid at every look
  std::optional<std::int64_t> noticed_after;  // answers (problems, of refusals), at level kShiftLevel
  std::string feature;                        // that differs most, or "refusals"
  double strange_share = 0.0;  // of all answers: those called strange, kStrangeLevel if none differ
};
inline constexpr double kShiftLevel = 0.05;

struct ConformReport {
  ConformRule rule;
  std::string label;                   // of the estimator
  std::vector<JudgedAnswer> judged;    // by cross-validation, or new ones
  std::vector<AskedProblem> problems;  // answered and refused ones
  std::int64_t num_unscored = 0;
  bool is_check = false;        // of a rule that is there, by new answers
  bool has_real_truth = false;  // a measured one, of real pairs
  bool shares_images = false;   // real pairs counted as if they were independent
  std::optional<ShiftFinding> shift;
  std::optional<PromiseFinding> kept;  // are the promises kept; of a check
};

// By two tests, each at half the level: of what is seen of answers, and of how often there is none.
ShiftFinding LookForShift(const ConformRule& rule, const AnswerRows& answers);

// The rule of a file that is to be checked, or to lend its models (nothing for an empty path). Throw
// InputError as ReadConformFile, if it is of the plan's own problems, and, of models, if it is of another
// estimator.
ConformRule LoadToCheck(const StudyPlan& plan, const std::string& path);
std::optional<ConformRule> LoadModels(const StudyPlan& plan, const std::string& path);

// Of the plan's one estimator. `models`: as FitConformRule; may be null. Throws InputError as that.
ConformReport CalibrateConform(const StudyPlan& plan, NewProblem new_problem, const ConformPromise& promise,
                               const ConformRule* models, const AnswerRows& answers);
// Of a rule whose estimator is the plan's.
ConformReport CheckConform(const StudyPlan& plan, const ConformRule& rule, const AnswerRows& answers);

}  // namespace rcme
