// What scripts/fit_calibrated fits the constants of rcme_calibrated to, from every trial of a study. Truth is
// in the choice of the rows and in the last columns alone.
//   rcme_calibrated_terms LISTING STUDY [SEED] [TRIALS] [THREADS, default one per core] > CSV
// The bytes do not depend on the number of threads. Columns of every listing:
//   condition, trial     of the study
//   levels...            of the condition, one column per factor
// check: what the check goes by (estimator/calibrated/checked_probability.h), a row per answer that can be
// scored:
//   sign_*, spread_*     the signs of the probability of failure and of the covariance
//   posterior            probability of failure by the modes
//   homography_share     severity of the problem
//   nees                 of the covariance without the factor of the check
//   failed               0 or 1
// permuted: the same of the trial's matches with partners permuted at random, of which every answer is wrong.
// modes: what speaks for a right mode against a wrong one (ComputeModeTerms), a row per wrong mode:
//   mode_*               the terms
//   share                one over the number of the trial's rows
// second_motions: the same of two motions of their own (IsSecondMotion, ComputeSecondMotionTerms)
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "estimator/calibrated/checked_probability.h"
#include "estimator/calibrated/weigh_modes.h"
#include "estimator/estimators/rcme_calibrated.h"
#include "experiments/core/work/progress.h"
#include "experiments/run/run_trials.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/simulate_draw.h"
#include "experiments/trial/trial.h"
#include "stats/constants.h"

namespace rcme {
namespace {

std::string MakeCheckHeader() {
  std::string header;
  for (const FitTerm& x : ListCheckSigns({})) header += ",sign_" + x.name;
  for (const FitTerm& y : ListCovarianceSigns({})) header += ",spread_" + y.name;
  return header + ",posterior,homography_share,nees,failed\n";
}

std::string MakeTermsHeader(std::span<const char* const> names) {
  std::string header;
  for (const char* name : names) header += fmt::format(",mode_{}", name);
  return header + ",share\n";
}

// Empty where there is no answer, or no truth to score it by.
std::string FindCheckRow(const WeightInspection& estimator, const TrialData& data,
                         const FailureBounds& failure, const std::string& labels, RandomStream& rng) {
  CheckedVerdict verdict;
  const MotionEstimate estimate = estimator.EstimateChecked(data.problem, rng, &verdict);
  const TrialRecord record = Score(estimate, data, 0.0);
  if (estimate.status != MotionStatus::kOk || !IsScored(record)) return {};
  std::string row = labels;
  for (const FitTerm& x : ListCheckSigns(verdict.check)) row += fmt::format(",{:.9g}", x.value);
  for (const FitTerm& y : ListCovarianceSigns(verdict.check)) row += fmt::format(",{:.9g}", y.value);
  return row + fmt::format(",{:.9g},{:.9g},{:.9g},{:d}\n", verdict.by_modes, data.severity.homography_share,
                           record.nees, HasFailed(record, failure));
}

// Every point of image 2 to another match, with what is known of its noise left where it is.
void PermutePartners(MotionProblem* problem, RandomStream& rng) {
  for (size_t i = problem->matches.size(); i > 1; --i)
    std::swap(problem->matches[i - 1].x2_px,
              problem->matches[rng.IntegerBelow(static_cast<std::uint32_t>(i))].x2_px);
}

std::string FindPermutedRow(const WeightInspection& estimator, const TrialData& data, const FailureBounds&,
                            const std::string& labels, RandomStream& rng) {
  TrialData permuted = data;
  PermutePartners(&permuted.problem, rng);
  const FailureBounds none{.max_rotation_error_deg = -1.0, .max_direction_error_deg = -1.0};
  return FindCheckRow(estimator, permuted, none, labels, rng);
}

// The terms for a right mode against a wrong one, a row per wrong mode, each with one over their number.
std::string FormatPairs(const std::vector<std::vector<double>>& pairs, const std::string& labels) {
  std::string rows;
  for (const std::vector<double>& terms : pairs) {
    rows += labels;
    for (const double x : terms) rows += fmt::format(",{:.9g}", x);
    rows += fmt::format(",{:.9g}\n", 1.0 / static_cast<double>(pairs.size()));
  }
  return rows;
}

// The terms of a pair, for the right mode.
template <typename Terms>
std::vector<double> OrientTerms(const Terms& terms, bool is_right_first) {
  std::vector<double> oriented(terms.begin(), terms.end());
  if (!is_right_first)
    for (double& x : oriented) x = -x;
  return oriented;
}

// The modes that explain at least `share` as many matches as the one that explains the most; which of them
// are within the failure bounds of the truth, and the most likely one of these.
struct JudgedByTruth {
  std::vector<ExplainedMode> modes;
  std::vector<bool> is_right, is_notable;
  size_t right = 0;  // the number of modes if none is
};
JudgedByTruth JudgeByTruth(std::vector<ExplainedMode> modes, const TrialData& data,
                           const FailureBounds& failure, double share) {
  int most = 0;
  for (const ExplainedMode& mode : modes) most = std::max(most, mode.explanation.num_explained);
  const MotionBounds bounds{kRadPerDeg * failure.max_rotation_error_deg,
                            kRadPerDeg * failure.max_direction_error_deg};
  JudgedByTruth judged;
  judged.modes = std::move(modes);
  judged.right = judged.modes.size();
  for (size_t i = 0; i < judged.modes.size(); ++i) {
    const ExplainedMode& mode = judged.modes[i];
    judged.is_notable.push_back(mode.explanation.num_explained >= share * most);
    judged.is_right.push_back(IsWithin(*data.truth.cam2_from_cam1_true, bounds, mode.mode.pose));
    if (!judged.is_notable[i] || !judged.is_right[i]) continue;
    if (judged.right == judged.modes.size() ||
        mode.mode.log_likelihood > judged.modes[judged.right].mode.log_likelihood)
      judged.right = i;
  }
  return judged;
}

// Lists the pairs of the right mode and a wrong one that are two motions of their own, or those that are not.
template <typename FindTerms>
std::string FindPairRows(const JudgedByTruth& judged, bool are_second_motions, const FindTerms& find_terms,
                         const std::string& labels) {
  std::vector<std::vector<double>> pairs;
  for (const ModePair& pair : ListModePairs(judged.modes)) {
    if (pair.is_second_motion != are_second_motions) continue;
    if (pair.a != judged.right && pair.b != judged.right) continue;
    const size_t other = pair.a == judged.right ? pair.b : pair.a;
    if (judged.is_right[other] || !judged.is_notable[other]) continue;
    pairs.push_back(OrientTerms(find_terms(pair), pair.a == judged.right));
  }
  return FormatPairs(pairs, labels);
}

// Of the modes that explain at least half as many matches as the one that explains the most.
std::string FindModeRows(const WeightInspection& estimator, const TrialData& data,
                         const FailureBounds& failure, const std::string& labels, RandomStream& rng) {
  const JudgedByTruth judged = JudgeByTruth(estimator.ListModes(data.problem, rng), data, failure, 0.5);
  return FindPairRows(
      judged, false, [](const ModePair& pair) { return pair.terms; }, labels);
}

// Of all modes: the camera's motion may have far fewer matches than an object's.
std::string FindSecondMotionRows(const WeightInspection& estimator, const TrialData& data,
                                 const FailureBounds& failure, const std::string& labels, RandomStream& rng) {
  const JudgedByTruth judged = JudgeByTruth(estimator.ListModes(data.problem, rng), data, failure, 0.0);
  return FindPairRows(
      judged, true, [](const ModePair& pair) { return pair.second_motion_terms; }, labels);
}

// What is listed of a trial.
struct Listing {
  std::string header;
  std::string (*find_rows)(const WeightInspection& estimator, const TrialData& data,
                           const FailureBounds& failure, const std::string& labels, RandomStream& rng);
};

Listing FindListing(const std::string& name) {
  if (name == "check") return {MakeCheckHeader(), FindCheckRow};
  if (name == "permuted") return {MakeCheckHeader(), FindPermutedRow};
  if (name == "modes") return {MakeTermsHeader(kModeTermNames), FindModeRows};
  if (name == "second_motions") return {MakeTermsHeader(kSecondMotionTermNames), FindSecondMotionRows};
  throw InputError("LISTING is check, permuted, modes or second_motions, not '" + name + "'");
}

std::string MakeHeader(const StudyPlan& plan, const Listing& listing) {
  std::string header = "condition,trial";
  for (const std::string& name : plan.factor_names) header += "," + name;
  return header + listing.header;
}

// Empty where there is no problem, or no direction that could be right.
std::string FindRows(const StudyPlan& plan, const Condition& condition, std::uint32_t trial,
                     const WeightInspection& estimator, const Listing& listing) {
  const StreamName name = NameOfTrial(plan, condition, trial);
  const auto simulated = SimulateDraw(plan.study, [&] { return condition.source->Make(name); });
  if (!simulated.made || !simulated.made->truth.is_direction_known) return {};
  std::string labels = fmt::format("{},{}", condition.index, trial);
  for (const std::string& level : condition.levels) labels += "," + level;
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  return listing.find_rows(estimator, *simulated.made, plan.study.failure, labels, rng);
}

int Run(int argc, char** argv) {
  const Listing listing = FindListing(argv[1]);
  Study study = LoadStudy(argv[2]);
  if (argc > 3) study.seed = std::strtoull(argv[3], nullptr, 10);
  if (argc > 4) study.trials = std::atoi(argv[4]);
  const int num_threads = argc > 5 ? std::atoi(argv[5]) : 0;
  const StudyPlan plan = MakePlan(study, PlanEstimators::kNotMade);
  CalibratedOptions options;
  options.leave_out = CalibratedStep::kModelCheck;
  const std::unique_ptr<MotionEstimator> estimator = MakeRcmeCalibrated(options);
  const WeightInspection* inspection = FindWeightInspection(*estimator);
  std::vector<std::string> rows(static_cast<size_t>(plan.NumTrials()));
  Progress progress("trials", plan.NumTrials());
  const auto add = [&](const Condition& condition, std::uint32_t trial, std::int64_t index) {
    rows[static_cast<size_t>(index)] = FindRows(plan, condition, trial, *inspection, listing);
    progress.Advance(1);
  };
  ForEachTrial(plan, {0, static_cast<std::uint32_t>(study.trials)}, add, num_threads);
  fmt::print("{}{}", MakeHeader(plan, listing), fmt::join(rows, ""));
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(
        stderr,
        "usage: rcme_calibrated_terms check|permuted|modes|second_motions STUDY [SEED] [TRIALS] [THREADS]\n");
    return 2;
  }
  try {
    return rcme::Run(argc, argv);
  } catch (const rcme::InputError& error) {
    fmt::print(stderr, "rcme_calibrated_terms: {}\n", error.what());
    return 2;
  }
}
