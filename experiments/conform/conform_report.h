// Calibrates an estimator with the answers of a plan, or checks an earlier calibration on new problems.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/conform/calibration_work.h"
#include "experiments/conform/cross_validate.h"
#include "experiments/conform/set_promises.h"
#include "experiments/conform/test_promises.h"

namespace rcme {

// Whether new problems differ from those of the calibration.
struct ShiftFinding {
  std::int64_t num_looked_at = 0;             // answers tested, in random order, one of each group
  bool could_notice = false;                  // enough answers to notice the greatest possible shift
  double p_value = 1.0;                       // valid at every look
  std::optional<std::int64_t> noticed_after;  // answers (for refusals: problems), at level .05
  std::string feature;                        // the one that differs most, or "refusals"
  double strange_share = 0.0;  // share of the answers called strange; about kStrangeLevel without a shift
};

struct ConformReport {
  ConformRule rule;
  std::string label;                   // of the estimator
  std::vector<JudgedAnswer> judged;    // calibration: by cross-validation; check: new answers
  std::vector<AskedProblem> problems;  // answered and refused ones
  std::int64_t num_unscored = 0;
  bool is_check = false;        // checks an existing rule with new answers
  bool has_real_truth = false;  // real pairs, whose truth is measured
  bool shares_images = false;   // calibration with real pairs that are counted as independent
  std::optional<ShiftFinding> shift;
  std::optional<PromiseFinding> kept;  // of a check
};

// Runs two tests, each at half the level: one of the visible features (each at an equal part of that half),
// one of the refusal rate.
ShiftFinding LookForShift(const ConformRule& rule, const AnswerRows& answers);

// LoadToCheck reads a rule to check; LoadModels reads a rule whose models are to be used again (nothing for
// an empty path). Both throw InputError as ReadConformFile does, and if the rule was calibrated with any of
// the plan's own problems. LoadModels also throws it if the rule is for another estimator.
ConformRule LoadToCheck(const StudyPlan& plan, const std::string& path);
std::optional<ConformRule> LoadModels(const StudyPlan& plan, const std::string& path);

// Calibrates the plan's one estimator. `models` may be null, see FitConformRule. Throws InputError as
// FitConformRule does.
ConformReport CalibrateConform(const StudyPlan& plan, NewProblem new_problem, const ConformPromise& promise,
                               const ConformRule* models, const AnswerRows& answers);
// Checks a rule for the plan's estimator.
ConformReport CheckConform(const StudyPlan& plan, const ConformRule& rule, const AnswerRows& answers);

}  // namespace rcme
