// Why an answer is wrong, or missing: did the search fail, or can the estimator's own model not tell?
//
// The true motion is handed to the estimator as if its search had found it, and judged by the estimator's own
// score and tests (LoopInspection::ScoreMotion and Decide, WeightInspection::WeighMotions). It is refined
// there first: noise moves the optimum away from the truth, and a motion that was fitted is not to be held
// against one that was not. No call of Estimate sees the truth.
#pragma once

#include <optional>
#include <string>

#include "experiments/real/answer/motion_evidence.h"
#include "experiments/study/study.h"
#include "experiments/trial/trial.h"

namespace rcme {

enum class WhyVerdict {
  kRight,  // the answer is within the bounds
  // The true motion scores clearly better than the answer (by two standard deviations, or a probability of
  // 0.9), or would not have been refused.
  kSearchFailed,
  kModelCannotTell,  // it does not, or the matches have no optimum within the bounds
  kTestsRefuse,      // the tests would have refused the true motion, too
  kTruthUnknown,
};
// "right", "search_failed", "model_cannot_tell", "tests_refuse", "truth_unknown".
const char* Name(WhyVerdict verdict);

struct Why {
  WhyVerdict verdict = WhyVerdict::kTruthUnknown;
  std::string words;      // a sentence or two, with the scores
  std::string runner_up;  // the most likely other motion, of an estimator that keeps several; empty: none
};
Why ExplainOutcome(const EstimatorSpec& spec, const TrialData& data, const MotionEstimate& estimate,
                   const TrialRecord& record, const FailureBounds& bounds);

// What the true motion itself rests on: the right matches, where they are known, else those that agree with
// it at 95 %. Nothing where the truth is not known.
std::optional<MotionEvidence> EvidenceOfTruth(const TrialData& data);

// The above for people, of all estimators of a trial.
std::string WhyAsText(const StudyPlan& plan, const TrialResult& result);

}  // namespace rcme
