// The columns of the tables `problems` and `trials`, each with the field that it holds.
#pragma once

#include <fmt/format.h>

#include <string>
#include <type_traits>

#include "experiments/trial/severity_columns.h"
#include "experiments/trial/trial.h"

namespace rcme {

inline constexpr StoredColumn kConditionColumn = {"condition", "", "number, from 0", kAnyNumber,
                                                  StoredColumn::Role::kKey};
inline constexpr StoredColumn kTrialColumn = {"trial", "", "number in its condition, from 0", kAnyNumber,
                                              StoredColumn::Role::kKey};
inline constexpr StoredColumn kEstimatorColumn = {"estimator", "", "number, from 0", kAnyNumber,
                                                  StoredColumn::Role::kKey};

template <typename Record, typename Wanted>
concept IsRecord = std::is_same_v<std::remove_const_t<Record>, Wanted>;

template <IsRecord<StatedDensity> Density, typename Visitor>
void VisitDensityColumns(Density& density, Visitor&& visit) {
  visit(
      StoredColumn{
          "density", "",
          "0: no covariance, 1: covariance with a density, 2: singular covariance, hence no log_score"},
      density.kind);
  visit(
      StoredColumn{"rotation_sd_deg", "deg",
                   "root of the trace of the covariance's rotation block; NULL: no covariance", kNotNegative},
      density.rotation_sd_deg);
  visit(StoredColumn{"direction_sd_deg", "deg", "the same for the direction of translation", kNotNegative},
        density.direction_sd_deg);
  visit(StoredColumn{"sd_over_crb", "",
                     "geometric mean of both over their bounds; NULL: no covariance or bounds", kNotNegative},
        density.sd_over_crb);
  visit(StoredColumn{"log_det_cov", "", "ln det of the covariance (5x5, rad); NULL: none, or singular"},
        density.log_det_cov);
  visit(StoredColumn{"energy_score_deg", "deg",
                     "energy score of the stated density, 0 best; NULL: none, or no truth", kNotNegative},
        density.energy_score_deg);
  visit(StoredColumn{"log_score", "nats",
                     "-ln p(error) of the stated density; NULL: none, singular, or no truth"},
        density.log_score);
  visit(StoredColumn{"rotation_level_deg", "deg",
                     "stated protection level, exceeded with probability at most 0.01; NULL: no covariance",
                     kNotNegative},
        density.rotation_level_deg);
  visit(StoredColumn{"direction_level_deg", "deg", "the same for the direction of translation", kNotNegative},
        density.direction_level_deg);
}

// Calls `visit` with the StoredColumn and the field of each column, in the order of the file.
template <IsRecord<TrialRecord> Record, typename Visitor>
void VisitColumns(Record& record, Visitor&& visit) {
  visit(kConditionColumn, record.condition);
  visit(kTrialColumn, record.trial);
  visit(kEstimatorColumn, record.estimator);
  visit(StoredColumn{"status", "", "`ok`, the reason of a refusal, or what makes the answer invalid"},
        record.status);
  visit(StoredColumn{"rotation_error_deg", "deg", "NULL: no rotation or truth", kNotNegative},
        record.rotation_error_deg);
  visit(StoredColumn{"direction_error_deg", "deg", "NULL: no motion or true direction", kNotNegative},
        record.direction_error_deg);
  visit(
      StoredColumn{
          "nees", "",
          "normalised estimation error squared, 5 degrees of freedom; infinite for an invalid answer"},
      record.nees);
  visit(StoredColumn{"num_matches", "matches", "matches of the problem", kNotNegative}, record.num_matches);
  visit(StoredColumn{"num_inliers", "matches", "final inliers", kNotNegative}, record.num_inliers);
  visit(
      StoredColumn{"inlier_precision", "share",
                   "true matches among the final inliers, undetectable wrong ones left out", kFromZeroToOne},
      record.inlier_precision);
  // At most 1, because an answer that repeats an inlier is invalid (answer_check.h).
  visit(StoredColumn{"inlier_recall", "share", "final inliers among the true matches", kNotNegative},
        record.inlier_recall);
  visit(StoredColumn{"num_support", "matches", "n_j of the selected hypothesis"}, record.num_support);
  visit(StoredColumn{"mean_entropy", "nats", "psi_j of the selected hypothesis; NULL: none"},
        record.mean_entropy);
  visit(StoredColumn{"z_statistic", "", "Z_j of the selected hypothesis; NULL: none"}, record.z_statistic);
  visit(StoredColumn{"num_consistent_before", "matches", "n_I, before the refinement"},
        record.num_consistent_before);
  visit(StoredColumn{"num_consistent_after", "matches", "n*_I, after the refinement"},
        record.num_consistent_after);
  visit(StoredColumn{"failed_by_kappa", "0 or 1", "the paper's failure flag: n*_I / n_I <= kappa"},
        record.failed_by_kappa);
  visit(StoredColumn{"num_explained", "matches", "matches that agree with the refined motion"},
        record.num_explained);
  visit(StoredColumn{"num_hypotheses", "", "minimal samples drawn"}, record.counts.num_hypotheses);
  visit(StoredColumn{"num_degenerate_samples", "", "minimal samples without a motion"},
        record.counts.num_degenerate_samples);
  visit(StoredColumn{"num_inconsistent_samples", "", "minimal samples refused by the sample test"},
        record.counts.num_inconsistent_samples);
  visit(StoredColumn{"num_poor_inlier_sets", "", "hypotheses whose mean entropy exceeded mu"},
        record.counts.num_poor_inlier_sets);
  visit(StoredColumn{"num_too_small_inlier_sets", "", "hypotheses with too few inliers"},
        record.counts.num_too_small_inlier_sets);
  visit(StoredColumn{"num_candidates", "", "hypotheses that passed every test"},
        record.counts.num_candidates);
  visit(StoredColumn{"failure_probability", "", "stated by the estimator; NULL: not stated", kFromZeroToOne},
        record.failure_probability);
  visit(StoredColumn{"sigma_estimated_px", "px",
                     "noise per coordinate, estimated from the residuals; NULL: not stated", kNotNegative},
        record.sigma_estimated_px);
  visit(StoredColumn{"sigma_estimated_sd_px", "px", "its stated standard deviation; NULL: not stated",
                     kNotNegative},
        record.sigma_estimated_sd_px);
  visit(StoredColumn{"inlier_brier", "",
                     "mean squared error of inlier probabilities, undetectable wrong matches left out",
                     kFromZeroToOne},
        record.inlier_brier);
  VisitDensityColumns(record.density, visit);
  visit(
      StoredColumn{
          "doubt", "",
          "cause of uncertainty: 0 none, 1 another motion, 2 a plane, 3 few influential matches, 4 the "
          "opposite direction, 5 low parallax, 6 few matches, 7 matches that contradict the model"},
      record.doubt);
  visit(
      StoredColumn{
          "seconds", "s",
          "processor time of the call, plus time in another process; the only number that another run "
          "does not repeat",
          kFiniteAndKnown, StoredColumn::Role::kTime},
      record.seconds);
}

template <IsRecord<ProblemRecord> Record, typename Visitor>
void VisitColumns(Record& record, Visitor&& visit) {
  visit(kConditionColumn, record.condition);
  visit(kTrialColumn, record.trial);
  visit(StoredColumn{"weight", "",
                     "1, unless the number of outliers was drawn by importance sampling (`tilted_to`)",
                     kFiniteAndKnown},
        record.weight);
  visit(StoredColumn{"num_inliers_true", "matches", "true matches; NULL for real pairs", kFiniteOrUnknown},
        record.num_inliers_true);
  for (const SeverityColumn& column : kSeverityColumns) visit(column, record.severity.*column.field);
}

// Formats a field: numbers with all digits, a status by its name.
inline std::string FormatField(MotionStatus status) { return StatusName(status); }
inline std::string FormatField(bool flag) { return flag ? "yes" : "no"; }
template <typename Number>
std::string FormatField(Number number) {
  return fmt::format("{}", number);
}

// Whether two records agree in every column but the time.
inline bool AreEqualButForTime(const TrialRecord& a, const TrialRecord& b) {
  const auto join_fields = [](const TrialRecord& record) {
    std::string text;
    VisitColumns(record, [&](const StoredColumn& column, const auto& field) {
      if (column.role != StoredColumn::Role::kTime) text += FormatField(field) + " ";
    });
    return text;
  };
  return join_fields(a) == join_fields(b);
}

}  // namespace rcme
