#include "experiments/rare/stratified_failures.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/core/work/for_each_index.h"
#include "experiments/audit/claims/cramer_rao.h"
#include "experiments/audit/claims/study_cases.h"
#include "experiments/rare/failing_motion.h"
#include "experiments/trial/trial.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

// Of the streams that decide which trials are run, beside the purposes of a trial's streams (StreamPurpose).
constexpr std::uint32_t kThinningPurpose = 101;
// The pilot's trials: far beyond those of any run.
constexpr std::uint32_t kFirstPilotTrial = 4'000'000'000, kNumPilotTrials = 1000;
constexpr std::uint8_t kNotRun = 0x80;

double TailOf(double bound_deg, double variance) {
  return std::erfc(bound_deg * std::numbers::pi / 180.0 / std::sqrt(2.0 * variance));
}

// The strata of one condition: what is known of a trial before any estimator is called.
class Strata {
 public:
  Strata(const StudyPlan& plan, const Condition& condition, double run_share)
      : plan_(plan), condition_(condition), make_(StudyCases(plan, condition)) {
    std::vector<double> chances;
    for (std::uint32_t i = 0; i < kNumPilotTrials; ++i) chances.push_back(ChanceOf(kFirstPilotTrial + i));
    // The share that is run falls as p_hard rises.
    double lower = -700.0, upper = 50.0;  // of its logarithm
    for (int i = 0; i < 60; ++i) {
      log_hard_ = 0.5 * (lower + upper);
      double num_run = 0.0;
      for (const double chance : chances) num_run += std::ldexp(1.0, -StratumOfChance(chance));
      (num_run > run_share * kNumPilotTrials ? lower : upper) = log_hard_;
    }
  }

  int StratumOf(std::uint32_t trial) const { return StratumOfChance(ChanceOf(trial)); }

  bool IsRun(std::uint32_t trial, int stratum) const {
    RandomStream rng({plan_.study.seed, condition_.stream_key, trial, kThinningPurpose});
    return rng.Uniform() < std::ldexp(1.0, -stratum);
  }

 private:
  // 1 where the matches do not determine the motion.
  double ChanceOf(std::uint32_t trial) const {
    const std::optional<Matrix5d> bound = CramerRaoBound(make_(NameOfTrial(plan_, condition_, trial)));
    const double chance = bound ? FailureChanceOfBound(*bound, plan_.study.failure) : 1.0;
    return std::isfinite(chance) ? chance : 1.0;
  }
  int StratumOfChance(double chance) const {
    const double log2_thinning = 0.5 * (log_hard_ - std::log(std::max(chance, 1e-300))) / std::numbers::ln2;
    return static_cast<int>(std::clamp(std::floor(log2_thinning), 0.0, kNumStrata - 1.0));
  }

  const StudyPlan& plan_;
  const Condition& condition_;
  CaseMaker make_;
  double log_hard_ = 0.0;
};

// The cells of one condition.
std::vector<StratifiedCell> CellsOf(const StudyPlan& plan, const Condition& condition,
                                    const StratifiedEffort& effort, int num_threads, Progress* progress) {
  const Strata strata(plan, condition, effort.run_share);
  const size_t num_estimators = plan.estimators.size();
  std::vector<std::uint8_t> stratum(effort.num_trials), has_failed(effort.num_trials * num_estimators);
  std::vector<double> weight(effort.num_trials, 1.0);
  ForEachIndex(effort.num_trials, num_threads, [&](std::int64_t index) {
    const auto i = static_cast<size_t>(index);
    const auto trial = static_cast<std::uint32_t>(index);
    const int k = strata.StratumOf(trial);
    stratum[i] = static_cast<std::uint8_t>(k);
    if (strata.IsRun(trial, k)) {
      const TrialResult result = RunTrial(plan, condition, trial);
      weight[i] = std::ldexp(result.problem.weight, k);
      for (size_t e = 0; e < num_estimators; ++e)
        has_failed[i * num_estimators + e] = HasFailed(result.records[e], plan.study.failure);
    } else {
      stratum[i] |= kNotRun;
    }
    progress->Advance(1);
  });
  std::vector<StratifiedCell> cells(num_estimators);
  for (size_t e = 0; e < num_estimators; ++e) {
    StratifiedCell& cell = cells[e];
    cell.condition = condition.index;
    cell.estimator = e;
    WeightedEvents events;
    for (size_t i = 0; i < stratum.size(); ++i) {
      StratumCount& count = cell.strata[stratum[i] & ~kNotRun];
      ++count.num_trials;
      if ((stratum[i] & kNotRun) != 0) continue;
      ++count.num_run;
      count.num_failed += has_failed[i * num_estimators + e];
      events.Add(weight[i], has_failed[i * num_estimators + e] != 0);
    }
    cell.num_run = events.num_trials;
    events.num_trials = effort.num_trials;  // what is not run counts nothing, but was drawn
    cell.rate = EstimateWeightedRate(events);
  }
  return cells;
}

}  // namespace

double FailureChanceOfBound(const Matrix5d& bound, const FailureBounds& bounds) {
  const double rotation =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(bound.topLeftCorner<3, 3>()).eigenvalues()(2);
  const double direction =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(bound.bottomRightCorner<2, 2>()).eigenvalues()(1);
  return std::max(TailOf(bounds.max_rotation_error_deg, rotation),
                  TailOf(bounds.max_direction_error_deg, direction));
}

std::vector<StratifiedCell> StratifyFailures(const StudyPlan& plan, const StratifiedEffort& effort,
                                             int num_threads, Progress* progress) {
  RequireDrawnScenes(plan.study);
  if (plan.study.repeats_per_scene > 1)
    throw InputError("rare: repeats_per_scene: trials that share a scene are not independent; leave it out");
  std::vector<StratifiedCell> cells;
  for (const Condition& condition : plan.conditions) {
    const std::vector<StratifiedCell> more = CellsOf(plan, condition, effort, num_threads, progress);
    cells.insert(cells.end(), more.begin(), more.end());
  }
  return cells;
}

}  // namespace rcme
