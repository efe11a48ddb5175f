// The terms of rcme_calibrated's check (estimator/calibrated/checked_probability.h) in every trial of a
// study, with what came of its answer: what scripts/fit_calibrated fits the constants to. Truth is in the
// last columns alone.
//   rcme_calibrated_terms STUDY [SEED] [TRIALS] > CSV
// One row per answer that can be scored:
//   condition, trial     of the study
//   levels...            of the condition, one column per factor
//   failure_*, spread_*  the terms
//   posterior            probability of failure by the modes
//   homography_share     severity of the problem
//   nees                 of the covariance without the factor of the check
//   failed               0 or 1
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <memory>

#include "estimator/calibrated/checked_probability.h"
#include "estimator/estimators/rcme_calibrated.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial.h"

namespace rcme {
namespace {

void PrintHeader(const StudyPlan& plan) {
  fmt::print("condition,trial");
  for (const std::string& name : plan.factor_names) fmt::print(",{}", name);
  for (const char* name : kFailureTermNames) fmt::print(",failure_{}", name);
  for (const char* name : kSpreadTermNames) fmt::print(",spread_{}", name);
  fmt::print(",posterior,homography_share,nees,failed\n");
}

void PrintTrial(const StudyPlan& plan, const Condition& condition, std::uint32_t trial,
                const WeightInspection& estimator) {
  const StreamName name = NameOfTrial(plan, condition, trial);
  const TrialData data = condition.source->Make(name);
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  CheckedVerdict verdict;
  const MotionEstimate estimate = estimator.EstimateChecked(data.problem, rng, &verdict);
  const TrialRecord record = Score(estimate, data, 0.0);
  if (estimate.status != MotionStatus::kOk || !data.truth.is_direction_known || !IsScored(record)) return;
  fmt::print("{},{}", condition.index, trial);
  for (const std::string& level : condition.levels) fmt::print(",{}", level);
  for (const double x : FailureTerms(verdict.by_modes, verdict.check)) fmt::print(",{:.9g}", x);
  for (const double x : SpreadTerms(verdict.check)) fmt::print(",{:.9g}", x);
  fmt::print(",{:.9g},{:.9g},{:.9g},{:d}\n", verdict.by_modes, data.severity.homography_share, record.nees,
             HasFailed(record, plan.study.failure));
}

int Run(int argc, char** argv) {
  Study study = LoadStudy(argv[1]);
  if (argc > 2) study.seed = std::strtoull(argv[2], nullptr, 10);
  if (argc > 3) study.trials = std::atoi(argv[3]);
  const StudyPlan plan = MakePlan(study, PlanEstimators::kNotMade);
  CalibratedOptions options;
  options.leave_out = CalibratedStep::kModelCheck;
  const std::unique_ptr<MotionEstimator> estimator = MakeRcmeCalibrated(options);
  const WeightInspection* inspection = FindWeightInspection(*estimator);
  PrintHeader(plan);
  for (const Condition& condition : plan.conditions) {
    for (std::uint32_t trial = 0; trial < static_cast<std::uint32_t>(condition.num_trials); ++trial) {
      try {
        PrintTrial(plan, condition, trial, *inspection);
      } catch (const NotSimulated&) {  // no problem, no answer
      }
    }
  }
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: rcme_calibrated_terms STUDY [SEED] [TRIALS]\n");
    return 2;
  }
  try {
    return rcme::Run(argc, argv);
  } catch (const rcme::InputError& error) {
    fmt::print(stderr, "rcme_calibrated_terms: {}\n", error.what());
    return 2;
  }
}
