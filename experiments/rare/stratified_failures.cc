#include "experiments/rare/stratified_failures.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "experiments/audit/claims/case.h"
#include "experiments/audit/claims/study_cases.h"
#include "experiments/rare/failing_motion.h"
#include "experiments/trial/simulate_draw.h"
#include "experiments/trial/trial.h"
#include "experiments/trial/trial_range.h"
#include "parameters/input_error.h"
#include "stats/constants.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

// The purpose of the streams that decide which trials are run, besides those of a trial's streams
// (StreamPurpose).
constexpr std::uint32_t kThinningPurpose = 101;
// The pilot's trials. Their numbers are far beyond those of any run.
constexpr std::uint32_t kFirstPilotTrial = 4'000'000'000, kNumPilotTrials = 1000;
constexpr std::uint32_t kTrialsOfRareItem = 100;

double ComputeTail(double bound_deg, double variance) {
  return std::erfc(RadFromDeg(bound_deg) / std::sqrt(2.0 * variance));
}

// The strata of one condition, computed before any estimator is called.
class Strata {
 public:
  Strata(const StudyPlan& plan, const Condition& condition, double run_share)
      : plan_(plan), condition_(condition), make_(StudyCases(plan, condition)) {
    std::vector<double> chances;  // of the trials that could be simulated
    for (std::uint32_t i = 0; i < kNumPilotTrials; ++i) {
      if (const std::optional<double> chance = FindChance(kFirstPilotTrial + i)) chances.push_back(*chance);
    }
    // The share of trials that are run decreases with p_hard.
    double lower = -700.0, upper = 50.0;  // of log p_hard
    for (int i = 0; i < 60; ++i) {
      log_hard_ = 0.5 * (lower + upper);
      double num_run = 0.0;
      for (const double chance : chances) num_run += std::ldexp(1.0, -StratumOfChance(chance));
      (num_run > run_share * static_cast<double>(chances.size()) ? lower : upper) = log_hard_;
    }
  }

  // Nullopt if the trial could not be simulated.
  std::optional<int> FindStratum(std::uint32_t trial) const {
    const std::optional<double> chance = FindChance(trial);
    return chance ? std::optional(StratumOfChance(*chance)) : std::nullopt;
  }

  bool IsRun(std::uint32_t trial, int stratum) const {
    RandomStream rng({plan_.study.seed, condition_.stream_key, trial, kThinningPurpose});
    return rng.Uniform() < std::ldexp(1.0, -stratum);
  }

 private:
  // 1 if the matches do not determine the motion; nullopt if the trial could not be simulated.
  std::optional<double> FindChance(std::uint32_t trial) const {
    const auto simulated =
        SimulateDraw(plan_.study, [&] { return make_(NameOfTrial(plan_, condition_, trial)); });
    if (!simulated.made) return std::nullopt;
    const std::optional<Matrix5d> bound = CramerRaoBound(*simulated.made);
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

TrialRange FindStratumTrials(const StratifiedEffort& effort, const ItemPlace& place) {
  const auto first = static_cast<std::uint32_t>(place.item) * kTrialsOfRareItem;
  return {first, std::min(first + kTrialsOfRareItem, effort.num_trials)};
}

constexpr char kNotSimulatedMark = '-';

// Runs some trials and returns a JSON list of three entries. First, one character per trial for its stratum:
// 0, ..., 6 if it was run, a, ..., g if not, kNotSimulatedMark if it could not be simulated. Second, the
// weight of each trial that was run. Third, one text per estimator with a character per trial that was run: 1
// if it failed, else 0.
std::string RunBlock(const StudyPlan& plan, const Condition& condition, const Strata& strata,
                     TrialRange trials) {
  std::string chosen;
  Json weights = Json::array();
  std::vector<std::string> has_failed(plan.estimators.size());
  for (std::uint32_t trial = trials.first; trial < trials.end; ++trial) {
    const std::optional<int> k = strata.FindStratum(trial);
    if (!k) {
      chosen += kNotSimulatedMark;
      continue;
    }
    const bool is_run = strata.IsRun(trial, *k);
    chosen += static_cast<char>((is_run ? '0' : 'a') + *k);
    if (!is_run) continue;
    const TrialResult result = RunTrial(plan, condition, trial);
    weights.push_back(NumberAsJson(std::ldexp(result.problem.weight, *k)));
    for (size_t e = 0; e < has_failed.size(); ++e)
      has_failed[e] += HasFailed(result.records[e], plan.study.failure) ? '1' : '0';
  }
  return Json::array({chosen, weights, has_failed}).dump();
}

// The sums of each estimator over the trials of one condition.
class StrataSum {
 public:
  explicit StrataSum(size_t num_estimators) : strata_(num_estimators), events_(num_estimators) {}

  // Adds a result of RunBlock for this many trials.
  void Add(const Json& json, size_t num_trials) {
    RequireSize(json, 3);
    const std::string chosen = json[0].get<std::string>();
    const auto is_stratum = [](char c, char first) { return c >= first && c < first + kNumStrata; };
    const auto has_failed = json[2].get<std::vector<std::string>>();
    if (chosen.size() != num_trials || has_failed.size() != events_.size())
      throw std::invalid_argument("it has other trials or estimators");
    size_t num_run = 0;
    for (const char c : chosen) {
      if (c == kNotSimulatedMark) {
        ++num_not_simulated_;
        continue;
      }
      const bool is_run = is_stratum(c, '0');
      if (!is_run && !is_stratum(c, 'a')) throw std::invalid_argument("a stratum that is none");
      const auto k = static_cast<size_t>(c - (is_run ? '0' : 'a'));
      for (size_t e = 0; e < events_.size(); ++e) {
        StratumCount& count = strata_[e][k];
        ++count.num_trials;
        if (!is_run) continue;
        const bool failed = FailedAt(has_failed[e], num_run);
        ++count.num_run;
        count.num_failed += failed;
        events_[e].Add(WeightAt(json[1], num_run), failed);
      }
      num_run += is_run;
    }
    RequireSize(json[1], num_run);
    if (!std::ranges::all_of(has_failed, [&](const std::string& of) { return of.size() == num_run; }))
      throw std::invalid_argument("it has other trials that were run");
  }

  StratifiedCell Take(size_t condition, size_t estimator, std::int64_t num_trials) const {
    StratifiedCell cell{condition,          estimator, strata_[estimator], events_[estimator].num_trials,
                        num_not_simulated_, {}};
    WeightedEvents events = events_[estimator];
    // trials that were not run have no weight but were drawn
    events.num_trials = num_trials - num_not_simulated_;
    cell.rate = EstimateWeightedRate(events);
    return cell;
  }

 private:
  static bool FailedAt(const std::string& has_failed, size_t place) {
    const char c = has_failed.at(place);
    if (c != '0' && c != '1') throw std::invalid_argument("a failure that neither is nor is not");
    return c == '1';
  }
  static double WeightAt(const Json& weights, size_t place) {
    const double weight = NumberFrom(weights.at(place));
    if (!(weight >= 0.0) || std::isinf(weight)) throw std::invalid_argument("a weight that is none");
    return weight;
  }

  std::vector<std::array<StratumCount, kNumStrata>> strata_;  // per estimator, like events_
  std::vector<WeightedEvents> events_;
  std::int64_t num_not_simulated_ = 0;
};

}  // namespace

double FailureChanceOfBound(const Matrix5d& bound, const FailureBounds& bounds) {
  const double rotation =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(Eigen::Matrix3d(bound.topLeftCorner<3, 3>()))
          .eigenvalues()(2);
  const double direction =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(Eigen::Matrix2d(bound.bottomRightCorner<2, 2>()))
          .eigenvalues()(1);
  return std::max(ComputeTail(bounds.max_rotation_error_deg, rotation),
                  ComputeTail(bounds.max_direction_error_deg, direction));
}

WorkPlan PlanStrata(const StudyPlan& plan, const StratifiedEffort& effort) {
  RequireDrawnScenes(plan.study);
  if (plan.study.repeats_per_scene > 1)
    throw InputError("rare: repeats_per_scene: trials that share a scene are not independent; leave it out");
  WorkPlan work{
      "stratification",
      "block",
      fmt::format("trials: {}\nrun share: {}\n{}", effort.num_trials, effort.run_share, plan.identity),
      {}};
  const size_t num_blocks = (effort.num_trials + kTrialsOfRareItem - 1) / kTrialsOfRareItem;
  for (const Condition& condition : plan.conditions)
    work.groups.push_back({fmt::format("condition {}", condition.index), num_blocks});
  return work;
}

std::vector<StratifiedCell> StratifyFailures(const StudyPlan& plan, const StratifiedEffort& effort,
                                             Runner* runner) {
  const WorkPlan& work = runner->plan();
  std::vector<Strata> strata;
  for (const Condition& condition : plan.conditions) strata.emplace_back(plan, condition, effort.run_share);
  runner->Get(ListItems(work, {}), [&](const ItemPlace& place) {
    return RunBlock(plan, plan.conditions[place.group], strata[place.group],
                    FindStratumTrials(effort, place));
  });
  std::vector<StratifiedCell> cells;
  for (size_t c = 0; c < plan.conditions.size(); ++c) {
    StrataSum sum(plan.estimators.size());
    ReadResults(work, runner->results(), c, c + 1, [&](const ItemPlace& place, const std::string& json) {
      const TrialRange trials = FindStratumTrials(effort, place);
      sum.Add(ParsePiece(json), trials.end - trials.first);
    });
    for (size_t e = 0; e < plan.estimators.size(); ++e)
      cells.push_back(sum.Take(plan.conditions[c].index, e, effort.num_trials));
  }
  return cells;
}

}  // namespace rcme
