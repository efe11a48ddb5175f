// The usual measures of a motion's error, by name, and what each trial contributes to them. All use one
// error in degrees: that of the rotation, that of the direction, or the greater of the two.
//
//   AUC at t  mean over trials of max(0, 1 - error / t). This is the area under the recall curve (the share
//             of trials with an error of at most u, as a function of u) from 0 to t, divided by t. It is
//             exact; published code often joins the points of the curve by straight lines.
//   mAA(10)   mean over the thresholds 1, 2, ..., 10 degrees of the share of trials with an error of at most
//             the threshold, as in the image-matching benchmark (Jin et al. 2021). Others use the name for a
//             mean of AUCs.
//
// The direction error is the angle between the vectors, 0 to 180 degrees, so the opposite direction is
// wrong. Most tables of learned matchers use the better of t and -t.
//
// Refusals and invalid answers have an infinite error and score 0. A measure with the suffix _answered
// leaves out refusals but keeps invalid answers. All measures leave out trials that are not scored.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

struct TrialMeasure {
  enum class Quantity { kScore, kRotationError, kDirectionError, kMaxError };

  std::string name, doc;
  Quantity quantity = Quantity::kScore;
  double (*score)(double max_error_deg) = nullptr;  // in [0, 1]; for Quantity::kScore
  bool leaves_out_refusals = false;
  std::string base = "scored trials";  // the trials that count

  // Returns what the trial contributes: a score, or an error in degrees. Nothing if the measure leaves the
  // trial out.
  std::optional<double> Of(const TrialRecord& record) const;
};

// Measures that are averaged: auc_5_deg, ..., maa_10_deg, then the same with _answered.
const std::vector<TrialMeasure>& TrialScores();
// Measures whose median is reported: rotation_error_median_deg, ..., then the same with _answered.
const std::vector<TrialMeasure>& TrialErrors();

}  // namespace rcme
