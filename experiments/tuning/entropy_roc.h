// How well psi, the mean entropy of an inlier set, separates good models from others. This limits what any
// threshold mu can achieve.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_range.h"
#include "stats/area_under_curve.h"

namespace rcme {

struct EntropyRoc {
  size_t estimator = 0;  // index in the study
  // "samples": from each trial, the first model of eight true matches (good) and the first of a sample with a
  // wrong match (bad), among those that pass the sample test. "winners": the model selected without a quality
  // test; it is good if the estimate is within the bounds.
  std::string population;
  std::vector<double> good, bad;  // psi; at most one of each per trial
  // P(psi of a good one < psi of a bad one), clustered by scene. A simulated trial has a scene of its own.
  AreaUnderCurve area;
};

// psi of the models of each kind in one trial of one estimator.
struct TrialEntropies {
  std::optional<double> good_sample, bad_sample, good_winner, bad_winner;
};

// [estimator][trial], the conditions one after the other. Empty for estimators whose loop cannot be
// inspected.
using EntropiesOfTrials = std::vector<std::vector<TrialEntropies>>;
EntropiesOfTrials MeasureEntropies(const StudyPlan& plan, TrialRange trials);

// The ROC of every estimator of the plan that has entropies. Left out if there was no good or no bad model.
// Every condition has the same trials.
std::vector<EntropyRoc> ComputeRocs(const StudyPlan& plan, const EntropiesOfTrials& entropies);

}  // namespace rcme
