// Whether psi, the mean entropy of an inlier set, tells good models from others: what a threshold mu can do
// at all.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_range.h"
#include "stats/area_under_curve.h"

namespace rcme {

struct EntropyRoc {
  size_t estimator = 0;  // in the study
  // "samples": of a trial the first model of eight true matches (good) and the first of a sample with a wrong
  // one (bad), among those that pass the sample test. "winners": the model that is selected without a quality
  // test, good where the estimate is within the bounds.
  std::string population;
  std::vector<double> good, bad;  // psi; at most one of each per trial
  // P(psi of a good one < psi of a bad one); clustered by scene, which is a trial's own where it is
  // simulated.
  AreaUnderCurve area;
};

// psi of what a trial shows of each kind to one estimator.
struct TrialEntropies {
  std::optional<double> good_sample, bad_sample, good_winner, bad_winner;
};

// [estimator][trial], the conditions one after the other; nothing of estimators whose loop cannot be taken
// apart.
using EntropiesOfTrials = std::vector<std::vector<TrialEntropies>>;
EntropiesOfTrials MeasureEntropies(const StudyPlan& plan, TrialRange trials);

// For every estimator of the plan that has entropies; without those where no good or no bad one was seen. The
// trials are the same of every condition.
std::vector<EntropyRoc> ComputeRocs(const StudyPlan& plan, const EntropiesOfTrials& entropies);

}  // namespace rcme
