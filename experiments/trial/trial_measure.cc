#include "experiments/trial/trial_measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rcme {
namespace {

using Quantity = TrialMeasure::Quantity;

template <int kThresholdDeg>
double AreaUnderRecall(double error_deg) {
  return std::max(0.0, 1.0 - error_deg / kThresholdDeg);
}

double AccuracyUpTo10(double error_deg) {
  int num_reached = 0;
  for (int threshold_deg = 1; threshold_deg <= 10; ++threshold_deg) num_reached += error_deg <= threshold_deg;
  return num_reached / 10.0;
}

// NaN if the truth is not known. If only the direction's truth is unknown, kMaxError is the rotation error.
double ErrorDeg(const TrialRecord& record, Quantity quantity) {
  if (record.status != MotionStatus::kOk) return std::numeric_limits<double>::infinity();
  if (quantity == Quantity::kRotationError) return record.rotation_error_deg;
  if (quantity == Quantity::kDirectionError) return record.direction_error_deg;
  return std::fmax(record.rotation_error_deg, record.direction_error_deg);
}

// Returns the measures, then the same without refusals.
std::vector<TrialMeasure> WithAnswered(const std::vector<TrialMeasure>& of_all) {
  std::vector<TrialMeasure> measures = of_all;
  for (TrialMeasure measure : of_all) {
    measure.name += "_answered";
    measure.base = "scored answers";
    measure.leaves_out_refusals = true;
    measures.push_back(measure);
  }
  return measures;
}

}  // namespace

std::optional<double> TrialMeasure::Of(const TrialRecord& record) const {
  if (!IsScored(record) || (leaves_out_refusals && HasRefused(record))) return std::nullopt;
  const double error_deg = ErrorDeg(record, quantity);
  if (std::isnan(error_deg)) return std::nullopt;
  return quantity == Quantity::kScore ? score(error_deg) : error_deg;
}

const std::vector<TrialMeasure>& TrialScores() {
  static const std::vector<TrialMeasure> scores = WithAnswered(
      {{"auc_5_deg", "AUC@5: mean of max(0, 1 - e / 5 deg), e the greater of both errors", Quantity::kScore,
        AreaUnderRecall<5>},
       {"auc_10_deg", "AUC@10: mean of max(0, 1 - e / 10 deg)", Quantity::kScore, AreaUnderRecall<10>},
       {"auc_20_deg", "AUC@20: mean of max(0, 1 - e / 20 deg)", Quantity::kScore, AreaUnderRecall<20>},
       {"maa_10_deg", "mAA(10): mean share with e at most 1, 2, ..., 10 deg", Quantity::kScore,
        AccuracyUpTo10}});
  return scores;
}

const std::vector<TrialMeasure>& TrialErrors() {
  static const std::vector<TrialMeasure> errors = WithAnswered(
      {{"rotation_error_median_deg", "rotation error", Quantity::kRotationError},
       {"direction_error_median_deg", "error of the translation direction", Quantity::kDirectionError},
       {"max_error_median_deg", "the greater of both errors", Quantity::kMaxError}});
  return errors;
}

}  // namespace rcme
