#include "experiments/tuning/entropy_roc.h"

#include <algorithm>
#include <optional>

#include "estimator/estimator_registry.h"
#include "estimator/ransac_estimator.h"
#include "experiments/for_each_index.h"
#include "experiments/trial.h"
#include "experiments/tuning/tuning.h"

namespace rcme {
namespace {

// psi of what a trial shows of each kind.
struct Entropies {
  std::optional<double> good_sample, bad_sample, good_winner, bad_winner;
};

bool IsAllTrue(const Sample& sample, const std::vector<bool>& is_inlier_true) {
  return std::ranges::all_of(sample, [&](int i) { return is_inlier_true[static_cast<size_t>(i)]; });
}

void AddSamples(const HypothesisTrace& trace, const Truth& truth, Entropies* entropies) {
  if (truth.is_inlier_true.empty()) return;
  for (const ScoredHypothesis& hypothesis : trace.hypotheses) {
    if (hypothesis.proposal.verdict != SampleVerdict::kConsistent || hypothesis.score.num_inliers == 0)
      continue;
    const bool is_good = IsAllTrue(hypothesis.proposal.sample, truth.is_inlier_true);
    std::optional<double>& first = is_good ? entropies->good_sample : entropies->bad_sample;
    if (!first) first = hypothesis.score.mean_entropy;
  }
}

Entropies EntropiesOf(const RansacEstimator& estimator, const TrialData& data, StreamName name,
                      const FailureBounds& bounds) {
  Entropies entropies;
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  const HypothesisTrace trace = estimator.Trace(data.problem, rng);
  AddSamples(trace, data.truth, &entropies);
  const LoopResult loop = estimator.Decide(trace);
  if (!loop.winner) return entropies;
  Refinements refinements;
  const TrialRecord record = Score(estimator.Finish(data.problem, loop, &refinements), data, 0.0);
  if (record.status != MotionStatus::kOk) return entropies;
  (HasFailed(record, bounds) ? entropies.bad_winner : entropies.good_winner) = record.mean_entropy;
  return entropies;
}

// The estimators of the plan without their quality test; null where an estimator's loop cannot be taken
// apart.
std::vector<std::unique_ptr<const MotionEstimator>> WithoutQualityTest(const StudyPlan& plan) {
  std::vector<std::unique_ptr<const MotionEstimator>> estimators;
  for (EstimatorSpec spec : plan.study.estimators) {
    spec.options.mu = kNoQualityTest;
    estimators.push_back(FindEstimator(spec.name).make(spec.options));
    if (!AsRansac(*estimators.back())) estimators.back().reset();
  }
  return estimators;
}

// Not all the same number: an estimator without entropies leaves psi at zero.
bool AreDifferent(const std::vector<double>& good, const std::vector<double>& bad) {
  const auto differs = [&](double psi) { return psi != good.front(); };
  return std::ranges::any_of(good, differs) || std::ranges::any_of(bad, differs);
}

void AddRoc(size_t estimator, const std::string& of, const std::vector<Entropies>& trials,
            std::optional<double> Entropies::*good, std::optional<double> Entropies::*bad,
            std::vector<EntropyRoc>* rocs) {
  EntropyRoc roc{estimator, of, {}, {}, {}};
  for (const Entropies& trial : trials) {
    if (trial.*good) roc.good.push_back(*(trial.*good));
    if (trial.*bad) roc.bad.push_back(*(trial.*bad));
  }
  if (roc.good.empty() || roc.bad.empty() || !AreDifferent(roc.good, roc.bad)) return;
  roc.area = MeasureAreaUnderCurve(roc.good, roc.bad);  // a bad one is positive: the higher psi
  rocs->push_back(std::move(roc));
}

}  // namespace

std::vector<EntropyRoc> MeasureEntropyRocs(const StudyPlan& plan, TrialRange trials, int num_threads,
                                           Progress* progress) {
  const auto estimators = WithoutQualityTest(plan);
  const auto per_condition = static_cast<std::int64_t>(trials.end - trials.first);
  const std::int64_t num_trials = per_condition * static_cast<std::int64_t>(plan.conditions.size());
  std::vector<std::vector<Entropies>> entropies(estimators.size(),
                                                std::vector<Entropies>(static_cast<size_t>(num_trials)));
  ForEachIndex(num_trials, num_threads, [&](std::int64_t index) {
    const Condition& condition = plan.conditions[static_cast<size_t>(index / per_condition)];
    const auto trial = trials.first + static_cast<std::uint32_t>(index % per_condition);
    const StreamName name{plan.study.seed, condition.index, trial, 0};
    const TrialData data = condition.source->Make(name);
    for (size_t e = 0; e < estimators.size(); ++e) {
      if (!estimators[e]) continue;
      entropies[e][static_cast<size_t>(index)] =
          EntropiesOf(*AsRansac(*estimators[e]), data, name, plan.study.failure);
    }
    progress->Advance(1);
  });
  std::vector<EntropyRoc> rocs;
  for (size_t e = 0; e < estimators.size(); ++e) {
    AddRoc(e, "samples", entropies[e], &Entropies::good_sample, &Entropies::bad_sample, &rocs);
    AddRoc(e, "winners", entropies[e], &Entropies::good_winner, &Entropies::bad_winner, &rocs);
  }
  return rocs;
}

}  // namespace rcme
