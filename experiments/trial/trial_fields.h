#pragma once

#include "experiments/trial/trial.h"

namespace rcme {

// The fields of a record with their column names, in one place: table, writing, reading and printing all
// visit them. `Record` is TrialRecord or const TrialRecord.
template <typename Record, typename Visitor>
void VisitFields(Record& record, Visitor&& visit) {
  visit("condition", record.condition);
  visit("trial", record.trial);
  visit("estimator", record.estimator);
  visit("status", record.status);
  visit("rotation_error_deg", record.rotation_error_deg);
  visit("direction_error_deg", record.direction_error_deg);
  visit("nees", record.nees);
  visit("num_matches", record.num_matches);
  visit("num_inliers", record.num_inliers);
  visit("inlier_precision", record.inlier_precision);
  visit("inlier_recall", record.inlier_recall);
  visit("num_support", record.num_support);
  visit("mean_entropy", record.mean_entropy);
  visit("z_statistic", record.z_statistic);
  visit("num_consistent_before", record.num_consistent_before);
  visit("num_consistent_after", record.num_consistent_after);
  visit("failed_by_kappa", record.failed_by_kappa);
  visit("num_explained", record.num_explained);
  visit("num_hypotheses", record.counts.num_hypotheses);
  visit("num_degenerate_samples", record.counts.num_degenerate_samples);
  visit("num_inconsistent_samples", record.counts.num_inconsistent_samples);
  visit("num_poor_inlier_sets", record.counts.num_poor_inlier_sets);
  visit("num_too_small_inlier_sets", record.counts.num_too_small_inlier_sets);
  visit("num_candidates", record.counts.num_candidates);
  visit("failure_probability", record.failure_probability);
  visit("sigma_estimated_px", record.sigma_estimated_px);
  visit("sigma_estimated_sd_px", record.sigma_estimated_sd_px);
  visit("inlier_brier", record.inlier_brier);
  visit("doubt", record.doubt);
  visit("seconds", record.seconds);
}

// The same for the record of a problem.
template <typename Record, typename Visitor>
void VisitProblemFields(Record& record, Visitor&& visit) {
  visit("condition", record.condition);
  visit("trial", record.trial);
  visit("weight", record.weight);
  visit("num_inliers_true", record.num_inliers_true);
  VisitSeverity(record.severity, visit);
}

}  // namespace rcme
