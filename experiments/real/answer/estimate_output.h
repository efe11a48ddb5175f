// Formats the answer to one pair of images for people and for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "estimator/protection_level.h"
#include "experiments/real/answer/calibration_effect.h"
#include "experiments/real/answer/motion_evidence.h"
#include "experiments/real/answer/probabilities_for_bounds.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/trial/trial.h"

namespace rcme {

// Protection levels of a motion (status ok) at the requested risk.
struct LevelsAtRisk {
  double risk = 0.0;
  ProtectionLevels levels;
};

// Some numbers of a posterior (calibrated/motion_posterior.h).
struct PosteriorSummary {
  double weight_of_none = 1.0, narrowed = 1.0;
  MotionDistance quantile_95 = {};  // of the rotation and of the direction error, each by itself
  RelativePose median;
};
PosteriorSummary SummarizePosterior(const MotionPosterior& posterior);

struct PairAnswer {
  MotionEstimate estimate;  // checked (trial/answer_check.h)
  TrialRecord record;       // scored if the file has a true motion
  MotionEvidence evidence;  // only for a motion (status ok)
  bool has_truth_sd = false;
  std::vector<ProbabilityForBounds> for_bounds = {};  // for the requested bounds
  std::optional<PosteriorSummary> posterior = {};     // if the estimator has one and it was kept
  std::optional<LevelsAtRisk> protection = {};
  // Of errors that the covariance does not have; empty if it has some, or without a motion.
  std::vector<CalibrationEffect> calibration_effects = {};
  bool has_prior = false;  // the problem had a prior
  int num_left_out = 0;    // matches of the file that have no ray (estimator/undistortion.h)
};

// Formats the motion, its uncertainty and its evidence; for a refusal the reason and what to try.
std::string AnswerAsText(const PairAnswer& answer, const EstimatorSpec& spec);

// The same for programs, without the format key (core/text/json_output.h).
nlohmann::ordered_json AnswerAsJson(const PairAnswer& answer, const EstimatorSpec& spec);

// Whether the stated probability is of matches unlike those that it was verified on.
bool IsExtrapolated(const PairAnswer& answer);

// The columns of a table over pairs beside the motions.
struct AnswerTableColumns {
  const std::vector<FailureBounds>& bounds;  // a failure probability for each
  bool with_levels = false, with_errors = false;
};
std::vector<std::string> ListAnswerColumns(const AnswerTableColumns& columns);
std::vector<std::string> FormatAnswerRow(const std::string& name, const PairAnswer& answer,
                                         const AnswerTableColumns& columns);
// Explains the columns. `integrity_risk` is that of the protection levels; empty without levels.
std::string AnswerLegend(bool with_errors, std::optional<double> integrity_risk, bool with_extrapolated);

// Returns whether the file is to blame: too few matches, invalid numbers, points on one line.
bool IsBadInput(MotionStatus status);

}  // namespace rcme
