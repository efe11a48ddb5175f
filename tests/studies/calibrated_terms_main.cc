// The terms of rcme_calibrated's check (estimator/calibrated/checked_probability.h) in every trial of a
// study, with what came of its answer: what scripts/fit_calibrated fits the constants to. Truth is in the
// last columns alone.
//   rcme_calibrated_terms STUDY [SEED] [TRIALS] [THREADS, default one per core] > CSV
// The bytes do not depend on the number of threads. One row per answer that can be scored:
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
#include <string>
#include <vector>

#include "estimator/calibrated/checked_probability.h"
#include "estimator/estimators/rcme_calibrated.h"
#include "experiments/core/work/progress.h"
#include "experiments/run/for_each_trial.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/simulate_draw.h"
#include "experiments/trial/trial.h"

namespace rcme {
namespace {

std::string MakeHeader(const StudyPlan& plan) {
  std::string header = "condition,trial";
  for (const std::string& name : plan.factor_names) header += "," + name;
  for (const FitTerm& term : ListFailureTerms(0.5, {})) header += ",failure_" + term.name;
  for (const FitTerm& term : ListSpreadTerms({})) header += ",spread_" + term.name;
  return header + ",posterior,homography_share,nees,failed\n";
}

// Empty where there is no problem, no answer, or no truth to score it by.
std::string FindRow(const StudyPlan& plan, const Condition& condition, std::uint32_t trial,
                    const WeightInspection& estimator) {
  const StreamName name = NameOfTrial(plan, condition, trial);
  const auto simulated = SimulateDraw(plan.study, [&] { return condition.source->Make(name); });
  if (!simulated.made) return {};
  const TrialData& data = *simulated.made;
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  CheckedVerdict verdict;
  const MotionEstimate estimate = estimator.EstimateChecked(data.problem, rng, &verdict);
  const TrialRecord record = Score(estimate, data, 0.0);
  if (estimate.status != MotionStatus::kOk || !data.truth.is_direction_known || !IsScored(record)) return {};
  std::string row = fmt::format("{},{}", condition.index, trial);
  for (const std::string& level : condition.levels) row += "," + level;
  for (const FitTerm& x : ListFailureTerms(verdict.by_modes, verdict.check))
    row += fmt::format(",{:.9g}", x.value);
  for (const FitTerm& y : ListSpreadTerms(verdict.check)) row += fmt::format(",{:.9g}", y.value);
  return row + fmt::format(",{:.9g},{:.9g},{:.9g},{:d}\n", verdict.by_modes, data.severity.homography_share,
                           record.nees, HasFailed(record, plan.study.failure));
}

int Run(int argc, char** argv) {
  Study study = LoadStudy(argv[1]);
  if (argc > 2) study.seed = std::strtoull(argv[2], nullptr, 10);
  if (argc > 3) study.trials = std::atoi(argv[3]);
  const int num_threads = argc > 4 ? std::atoi(argv[4]) : 0;
  const StudyPlan plan = MakePlan(study, PlanEstimators::kNotMade);
  CalibratedOptions options;
  options.leave_out = CalibratedStep::kModelCheck;
  const std::unique_ptr<MotionEstimator> estimator = MakeRcmeCalibrated(options);
  const WeightInspection* inspection = FindWeightInspection(*estimator);
  std::vector<std::string> rows(static_cast<size_t>(plan.NumTrials()));
  Progress progress("trials", plan.NumTrials());
  const auto add = [&](const Condition& condition, std::uint32_t trial, std::int64_t index) {
    rows[static_cast<size_t>(index)] = FindRow(plan, condition, trial, *inspection);
    progress.Advance(1);
  };
  ForEachTrial(plan, {0, static_cast<std::uint32_t>(study.trials)}, add, num_threads);
  fmt::print("{}{}", MakeHeader(plan), fmt::join(rows, ""));
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: rcme_calibrated_terms STUDY [SEED] [TRIALS] [THREADS]\n");
    return 2;
  }
  try {
    return rcme::Run(argc, argv);
  } catch (const rcme::InputError& error) {
    fmt::print(stderr, "rcme_calibrated_terms: {}\n", error.what());
    return 2;
  }
}
