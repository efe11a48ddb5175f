// The field's measures of a motion's error: what each trial contributes, by name. All are made of one error,
// the greater of the rotation's and the direction's, or of one of these, in degrees.
//
//   AUC at t mean over trials of max(0, 1 - error / t): the area under the recall curve (the share of trials
//            with an error of at most u, over u) from 0 to t, divided by t; exactly, where published code
//            often joins the points of the curve by straight lines.
//   mAA(10)  mean over the thresholds 1, 2, ..., 10 degrees of the share of trials with an error of at most
//            that, as in the image-matching benchmark (Jin et al. 2021); elsewhere a mean of AUCs is called
//            so.
//
// The direction's error is that of the vector, 0 to 180 degrees: a motion in the opposite direction is wrong,
// while tables of learned matchers mostly take the better of t and -t.
//
// A refusal and an answer that is not valid have an infinite error, and so score 0. A measure with the suffix
// _answered leaves refusals out (an answer that is not valid stays); both leave out what is not scored.
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

  // What the trial contributes: a score, or an error (deg). Nothing where the trial is not among those the
  // measure is about.
  std::optional<double> Of(const TrialRecord& record) const;
};

// auc_5_deg, ..., maa_10_deg, then the same _answered: their means are given.
const std::vector<TrialMeasure>& TrialScores();
// rotation_error_median_deg, ..., then the same _answered: their medians are given.
const std::vector<TrialMeasure>& TrialErrors();

}  // namespace rcme
