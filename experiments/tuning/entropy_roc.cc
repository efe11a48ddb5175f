#include "experiments/tuning/entropy_roc.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "estimator/loop_inspection.h"
#include "experiments/run/run_trials.h"
#include "experiments/trial/simulate_draw.h"
#include "experiments/trial/trial.h"

namespace rcme {
namespace {

bool IsAllTrue(const Sample& sample, const std::vector<bool>& is_inlier_true) {
  return std::ranges::all_of(sample, [&](int i) { return is_inlier_true[static_cast<size_t>(i)]; });
}

void AddSamples(const HypothesisTrace& trace, const Truth& truth, TrialEntropies* entropies) {
  if (truth.is_inlier_true.empty()) return;
  for (const ScoredHypothesis& hypothesis : trace.hypotheses) {
    if (hypothesis.proposal.verdict != SampleVerdict::kConsistent || hypothesis.score.num_inliers == 0)
      continue;
    const bool is_good = IsAllTrue(hypothesis.proposal.id.sample, truth.is_inlier_true);
    std::optional<double>& first = is_good ? entropies->good_sample : entropies->bad_sample;
    if (!first) first = hypothesis.score.mean_entropy;
  }
}

TrialEntropies MeasureTrialEntropies(const LoopInspection& estimator, const TrialData& data, StreamName name,
                                     const FailureBounds& bounds) {
  TrialEntropies entropies;
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  const HypothesisTrace trace = estimator.Trace(data.problem, rng);
  AddSamples(trace, data.truth, &entropies);
  const LoopResult loop = estimator.Decide(trace);
  if (!loop.winner) return entropies;
  Refinements refinements;
  const TrialRecord record = Score(estimator.Finish(data.problem, loop, &refinements), data, 0.0);
  if (HasRefused(record) || std::isnan(record.mean_entropy)) return entropies;
  (HasFailed(record, bounds) ? entropies.bad_winner : entropies.good_winner) = record.mean_entropy;
  return entropies;
}

// The estimators of the plan without their quality test; null for an estimator whose loop cannot be
// inspected.
std::vector<std::unique_ptr<const LoopInspection>> WithoutQualityTest(const StudyPlan& plan) {
  std::vector<std::unique_ptr<const LoopInspection>> estimators;
  for (const auto& estimator : plan.estimators) {
    estimators.push_back(nullptr);
    const LoopInspection* const ransac = FindInspection(*estimator);
    if (!ransac) continue;
    RansacOptions options = ransac->options();
    options.mu = kNoQualityTest;
    estimators.back() = ransac->With(options);
  }
  return estimators;
}

// Whether the numbers differ. An estimator without entropies leaves psi at zero.
bool AreDifferent(const std::vector<double>& good, const std::vector<double>& bad) {
  const auto differs = [&](double psi) { return psi != good.front(); };
  return std::ranges::any_of(good, differs) || std::ranges::any_of(bad, differs);
}

// The scene of each trial of all conditions. Pairs of one real scene share images; a simulated trial draws
// its own scene.
std::vector<size_t> NumberScenes(const StudyPlan& plan, std::int64_t trials_per_condition) {
  std::vector<size_t> scenes;
  std::map<std::string, size_t> common;
  size_t num_scenes = 0;
  for (const Condition& condition : plan.conditions) {
    const std::optional<std::string> shared = condition.source->SharedScene();
    for (std::int64_t trial = 0; trial < trials_per_condition; ++trial) {
      const size_t scene = shared ? common.try_emplace(*shared, num_scenes).first->second : num_scenes;
      scenes.push_back(scene);
      num_scenes += scene == num_scenes;
    }
  }
  return scenes;
}

void AddRoc(size_t estimator, const std::string& population, const std::vector<TrialEntropies>& trials,
            const std::vector<size_t>& scenes, std::optional<double> TrialEntropies::*good,
            std::optional<double> TrialEntropies::*bad, std::vector<EntropyRoc>* rocs) {
  EntropyRoc roc{estimator, population, {}, {}, {}};
  std::vector<ScoreCluster> clusters(scenes.empty() ? 0 : 1 + std::ranges::max(scenes));
  for (size_t t = 0; t < trials.size(); ++t) {
    if (const auto& psi = trials[t].*good) {
      roc.good.push_back(*psi);
      clusters[scenes[t]].negatives.push_back(*psi);
    }
    if (const auto& psi = trials[t].*bad) {  // positive: the higher psi
      roc.bad.push_back(*psi);
      clusters[scenes[t]].positives.push_back(*psi);
    }
  }
  if (roc.good.empty() || roc.bad.empty() || !AreDifferent(roc.good, roc.bad)) return;
  roc.area = MeasureClusteredAreaUnderCurve(clusters);
  rocs->push_back(std::move(roc));
}

}  // namespace

EntropiesOfTrials MeasureEntropies(const StudyPlan& plan, TrialRange trials) {
  const auto estimators = WithoutQualityTest(plan);
  const size_t num_trials = plan.conditions.size() * (trials.end - trials.first);
  EntropiesOfTrials entropies(estimators.size(), std::vector<TrialEntropies>(num_trials));
  ForEachTrial(plan, trials, [&](const Condition& condition, std::uint32_t trial, std::int64_t index) {
    const StreamName name = NameOfTrial(plan, condition, trial);
    const auto simulated = SimulateDraw(plan.study, [&] { return condition.source->Make(name); });
    if (!simulated.made) return;
    const TrialData& data = *simulated.made;
    for (size_t e = 0; e < estimators.size(); ++e) {
      if (!estimators[e]) continue;
      entropies[e][static_cast<size_t>(index)] =
          MeasureTrialEntropies(*estimators[e], data, name, plan.study.failure);
    }
  });
  return entropies;
}

std::vector<EntropyRoc> ComputeRocs(const StudyPlan& plan, const EntropiesOfTrials& entropies) {
  const auto num_trials = static_cast<std::int64_t>(entropies.front().size() / plan.conditions.size());
  const std::vector<size_t> scenes = NumberScenes(plan, num_trials);
  std::vector<EntropyRoc> rocs;
  for (size_t e = 0; e < entropies.size(); ++e) {
    AddRoc(e, "samples", entropies[e], scenes, &TrialEntropies::good_sample, &TrialEntropies::bad_sample,
           &rocs);
    AddRoc(e, "winners", entropies[e], scenes, &TrialEntropies::good_winner, &TrialEntropies::bad_winner,
           &rocs);
  }
  return rocs;
}

}  // namespace rcme
