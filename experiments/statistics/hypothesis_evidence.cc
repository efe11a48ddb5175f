#include "experiments/statistics/hypothesis_evidence.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/run/store/trial_totals.h"
#include "experiments/statistics/trial_groups.h"
#include "stats/clustered_estimate.h"

namespace rcme {
namespace {

const TrialQuantity& FindQuantity(const std::string& name) {
  const auto found = std::ranges::find(TrialQuantities(), name, &TrialQuantity::name);
  if (found == TrialQuantities().end()) throw std::logic_error("no quantity of trials: " + name);
  return *found;
}

// Says nothing alone: wide regions cover.
bool IsCoverage(const TrialQuantity& quantity) { return quantity.name == "nees_coverage"; }

std::optional<size_t> FindIfPresent(const RunDescription& run, const std::string& label) {
  const auto found = std::ranges::find(run.estimators, label, &DescribedEstimator::label);
  if (found == run.estimators.end()) return std::nullopt;
  return static_cast<size_t>(found - run.estimators.begin());
}

std::vector<bool> ConditionsWhere(const RunDescription& run, const Settings& where) {
  std::vector<bool> has(run.conditions.size(), true);
  for (const auto& [factor, level] : where) {
    const auto found = std::ranges::find(run.factors, factor);
    const auto f = static_cast<size_t>(found - run.factors.begin());
    for (size_t c = 0; c < has.size(); ++c)
      has[c] = has[c] && found != run.factors.end() && run.conditions[c].levels[f] == level;
  }
  return has;
}

}  // namespace

HypothesisEvidence::HypothesisEvidence(const RunDescription& run, const StatedHypothesis& stated)
    : quantity_(FindQuantity(stated.quantity)),
      estimator_(FindIfPresent(run, stated.estimator)),
      against_(FindIfPresent(run, stated.against)),
      is_paired_(!stated.against.empty()),
      is_of_means_(run.repeats_per_scene > 1 || quantity_.kind == SummaryRow::Kind::kScore),
      shares_scenes_(HasCommonScenes(run)),
      repeats_per_scene_(run.repeats_per_scene),
      bounds_(run.failure),
      has_(ConditionsWhere(run, stated.where)),
      cluster_of_(NumberDraws(run)),
      scores_(is_paired_ ? Interval{-1.0, 1.0} : Interval{0.0, 1.0}) {}

std::int64_t HypothesisEvidence::CountConditions() const { return std::ranges::count(has_, true); }

void HypothesisEvidence::Add(const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
  if (!has_[problem.condition]) return;
  const std::optional<double> first = quantity_.Measure(records[*estimator_], bounds_);
  const std::optional<double> second =
      is_paired_ ? quantity_.Measure(records[*against_], bounds_) : std::optional(0.0);
  if (!first || !second) return;
  if (IsCoverage(quantity_)) {
    sharpness_.Add(records[*estimator_]);
    if (is_paired_) sharpness_against_.Add(records[*against_]);
  }
  current_cluster_ = shares_scenes_
                         ? static_cast<size_t>(problem.trial) / static_cast<size_t>(repeats_per_scene_)
                         : cluster_of_[problem.condition];
  if (is_of_means_) return scene_.Add(*first - *second);
  const bool is_first = *first != 0.0, is_second = *second != 0.0;
  Cluster& cluster = clusters_[current_cluster_];
  if (shares_scenes_) cluster.values.push_back(*first - *second);
  cluster.count.num_events += is_first;
  ++cluster.count.num_trials;
  cluster.pair.num_first_only += is_first && !is_second;
  cluster.pair.num_second_only += is_second && !is_first;
  ++cluster.pair.num_trials;
  pairs_.Add(is_first, is_second);
}

void HypothesisEvidence::EndScene() {
  const std::optional<double> mean = scene_.Take();
  if (!mean) return;
  clusters_[current_cluster_].values.push_back(*mean);
  scores_.Add(*mean);
}

template <typename Field>
std::vector<Field> HypothesisEvidence::Clusters(Field Cluster::*field) const {
  std::vector<Field> all;
  for (const auto& [number, cluster] : clusters_) all.push_back(cluster.*field);
  return all;
}

MeasuredHypothesis HypothesisEvidence::Measure(bool is_of_population, double confidence) const {
  MeasuredHypothesis measured =
      is_of_population ? MeasureForPopulation(confidence) : MeasureForConditions(confidence);
  measured.n = is_of_means_ ? scores_.n() : pairs_.n();
  if (measured.n == 0) measured.value = std::nan("");
  return measured;
}

StatedSharpness HypothesisEvidence::MeasureSharpness(Side side) const {
  return (side == Side::kEstimator ? sharpness_ : sharpness_against_).Measure();
}

MeasuredHypothesis HypothesisEvidence::MeasureByClusters(double confidence) const {
  std::vector<double> values;
  std::vector<std::int64_t> numbers;
  for (const auto& [number, cluster] : clusters_) {
    values.insert(values.end(), cluster.values.begin(), cluster.values.end());
    numbers.resize(values.size(), static_cast<std::int64_t>(number));
  }
  const ClusteredEstimate mean =
      MeasureBoundedClusteredMean(values, {is_paired_ ? -1.0 : 0.0, 1.0}, numbers, confidence);
  return {mean.value, mean.interval};
}

MeasuredHypothesis HypothesisEvidence::MeasureForConditions(double confidence) const {
  if (shares_scenes_ && CountConditions() > 1) return MeasureByClusters(confidence);
  if (is_of_means_) return {scores_.mean(), scores_.Sequence(confidence)};
  if (is_paired_) return {pairs_.RiskDifference(), RiskDifferenceInterval(pairs_, confidence)};
  const std::int64_t num_events = pairs_.both + pairs_.first_only;
  return {static_cast<double>(num_events) / static_cast<double>(pairs_.n()),
          ExactBinomialInterval(num_events, pairs_.n(), confidence)};
}

MeasuredHypothesis HypothesisEvidence::MeasureForPopulation(double confidence) const {
  const auto pair_up = [](const auto& measured) {
    return MeasuredHypothesis{measured.value, measured.interval};
  };
  constexpr ConditionWeights kWeights = ConditionWeights::kByTrials;  // as in a pooled summary
  if (is_of_means_) return MeasureByClusters(confidence);
  if (is_paired_) return pair_up(MeasurePopulationDifference(Clusters(&Cluster::pair), kWeights, confidence));
  return pair_up(MeasurePopulationRate(Clusters(&Cluster::count), kWeights, confidence));
}

std::vector<std::int64_t> CountTrialsBefore(const RunDescription& run, int trials) {
  std::vector<std::int64_t> num_trials;
  for (const DescribedCondition& condition : run.conditions) {
    // A pass over a folder of pairs has several trials.
    const std::int64_t per_pass =
        run.stopping_rule.empty() && run.trials > 0 ? condition.num_trials / run.trials : 1;
    const std::int64_t asked_for = std::max<std::int64_t>(per_pass, 1) * trials;  // below 2^62
    num_trials.push_back(std::min(asked_for, kMaxTrialsOfCondition));
  }
  return num_trials;
}

EvidenceTrials ReadEvidence(const ResultStore& store, const RunDescription& run,
                            const std::vector<std::int64_t>& before,
                            std::vector<HypothesisEvidence>* evidence) {
  EvidenceTrials read{std::vector<std::int64_t>(run.conditions.size())};
  ForEachTrialByScene(
      ReadRun(store),
      [&](const ProblemRecord& problem, const std::vector<TrialRecord>& records, bool) {
        if (problem.trial >= before[problem.condition]) return;
        ++read.num_trials[problem.condition];
        read.is_weighted = read.is_weighted || problem.weight != 1.0;
        for (HypothesisEvidence& one : *evidence) {
          if (one.HasEstimators()) one.Add(problem, records);
        }
      },
      [&](std::uint32_t) {
        for (HypothesisEvidence& one : *evidence) one.EndScene();
      });
  return read;
}

}  // namespace rcme
