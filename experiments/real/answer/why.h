// Explains why an answer is wrong or missing: did the search fail, or can the estimator's own model not
// tell?
//
// The true motion is scored and tested by the estimator itself, as if its search had found it
// (LoopInspection::ScoreMotion and Decide, WeightInspection::WeighMotions). It is refined first: noise moves
// the optimum away from the truth, and a fitted motion must not be compared with one that was not fitted.
// Estimate itself never sees the truth.
#pragma once

#include <string>

#include "experiments/study/study.h"
#include "experiments/trial/trial.h"

namespace rcme {

enum class WhyVerdict {
  kRight,  // the answer is within the bounds
  // The true motion scores clearly better than the answer (by two standard deviations, or a probability of
  // 0.9), or would not have been refused.
  kSearchFailed,
  kModelCannotTell,  // it does not score clearly better, or the matches have no optimum within the bounds
  kTestsRefuse,      // the tests would also have refused the true motion
  kNoAnswer,         // code outside of the program raised an error, or what it gave cannot be read
  kTruthUnknown,
};
// Returns "right", "search_failed", "model_cannot_tell", "tests_refuse", "no_answer" or "truth_unknown".
const char* Name(WhyVerdict verdict);

struct Why {
  WhyVerdict verdict = WhyVerdict::kTruthUnknown;
  std::string words;      // one or two sentences with the scores
  std::string runner_up;  // most likely other motion, if the estimator keeps several; else empty
};
Why ExplainOutcome(const EstimatorSpec& spec, const TrialData& data, const MotionEstimate& estimate,
                   const TrialRecord& record, const FailureBounds& bounds);

// Formats the explanations for all estimators of a trial.
std::string WhyAsText(const StudyPlan& plan, const TrialResult& result);

}  // namespace rcme
