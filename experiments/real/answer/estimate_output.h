// The answer to one pair of images, for people and for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "estimator/protection_level.h"
#include "experiments/real/answer/motion_evidence.h"
#include "experiments/real/answer/probabilities_for_bounds.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/trial/trial.h"

namespace rcme {

// Of a motion (status ok), at the risk that was asked for.
struct LevelsAtRisk {
  double risk = 0.0;
  ProtectionLevels levels;
};

struct PairAnswer {
  MotionEstimate estimate;  // judged (trial/answer_check.h)
  TrialRecord record;       // scored against the file's truth, where it has one
  MotionEvidence evidence;  // only of a motion (status ok)
  bool has_truth_sd = false;
  std::vector<ProbabilityForBounds> for_bounds = {};  // those that were asked for
  std::optional<LevelsAtRisk> protection = {};
  bool has_prior = false;  // the problem had one
};

// What was found, how sure, what it rests on; of a refusal why, and what to try.
std::string AnswerAsText(const PairAnswer& answer, const EstimatorSpec& spec);

// The same for a program, but for the format (core/text/json_output.h).
nlohmann::ordered_json AnswerAsJson(const PairAnswer& answer, const EstimatorSpec& spec);

// What a table over pairs shows beside the motions.
struct AnswerTableColumns {
  const std::vector<FailureBounds>& bounds;  // a probability for each
  bool with_levels = false, with_errors = false;
};
std::vector<std::string> ListAnswerColumns(const AnswerTableColumns& columns);
std::vector<std::string> FormatAnswerRow(const std::string& name, const PairAnswer& answer,
                                         const AnswerTableColumns& columns);
// What the columns mean; `integrity_risk`: of the levels, nothing without them.
std::string AnswerLegend(bool with_errors, std::optional<double> integrity_risk);

// Whether the file, not the problem, is to blame: too few matches, bad numbers, points on one line.
bool IsBadInput(MotionStatus status);

}  // namespace rcme
