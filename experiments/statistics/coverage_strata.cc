#include "experiments/statistics/coverage_strata.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "experiments/statistics/coverage_verdict.h"
#include "experiments/statistics/failure_forecasts.h"
#include "experiments/statistics/population_summary.h"
#include "experiments/statistics/trial_groups.h"
#include "experiments/study/population.h"
#include "parameters/input_error.h"
#include "stats/clustered_estimate.h"
#include "stats/confidence_sequence.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/median_ratio.h"
#include "stats/population_rate.h"

namespace rcme {
namespace {

constexpr int kNumQuarters = 4;

// Returns the greatest value of each quarter except the last, ascending.
std::vector<double> FindCuts(std::vector<double> values) {
  std::ranges::sort(values);
  std::vector<double> cuts;
  for (size_t k = 1; k < kNumQuarters; ++k) {
    const size_t num_below = (k * values.size() + kNumQuarters - 1) / kNumQuarters;
    cuts.push_back(values[num_below - 1]);
  }
  return cuts;
}

Interval FindPopulationInterval(const std::vector<bool>& are_covered,
                                const std::vector<std::int64_t>& clusters) {
  std::map<std::int64_t, ConditionCount> of_cluster;
  for (size_t i = 0; i < clusters.size(); ++i) {
    ConditionCount& count = of_cluster[clusters[i]];
    ++count.num_trials;
    count.num_events += are_covered[i];
  }
  std::vector<ConditionCount> counts;
  for (const auto& [cluster, count] : of_cluster) counts.push_back(count);
  return MeasurePopulationRate(counts, ConditionWeights::kByTrials).interval;
}

Estimate MeasureCoverage(const std::vector<bool>& are_covered, const std::vector<std::int64_t>& clusters,
                         double level, StrataIntervals intervals) {
  ClusteredShare share = MeasureShareOfClusters(are_covered, clusters);
  if (intervals == StrataIntervals::kPopulation) {
    share.interval = FindPopulationInterval(are_covered, clusters);
  } else if (intervals == StrataIntervals::kAnytime && !share.has_shared_clusters) {
    share.interval = ConfidenceSequence(share.count, share.n);
  }
  if (level != kNominalCoverage) return {.value = share.value(), .interval = share.interval};
  const CoverageVerdict verdict =
      JudgeCoverage(share.value(), share.interval, share.n, share.n, intervals != StrataIntervals::kAnytime);
  return {.value = share.value(), .interval = share.interval, .note = std::string(Name(verdict.verdict))};
}

CoverageStratum MeasureStratum(const VisibleAnswers& answers, size_t quantity, int quarter,
                               const std::vector<size_t>& members, StrataIntervals intervals) {
  CoverageStratum stratum{answers.label, answers.seen_names[quantity], quarter, kNaN,
                          kNaN,          std::ssize(members),          {},      {}};
  std::vector<bool> are_covered;
  std::vector<std::int64_t> clusters;
  for (const size_t i : members) {
    are_covered.push_back(answers.are_covered[i]);
    clusters.push_back(answers.clusters[i]);
    stratum.least = std::fmin(stratum.least, answers.seen[quantity][i]);
    stratum.most = std::fmax(stratum.most, answers.seen[quantity][i]);
  }
  stratum.coverage = MeasureCoverage(are_covered, clusters, answers.level, intervals);
  for (const std::vector<double>& numbers : answers.sharpness) {
    std::vector<double> known;
    for (const size_t i : members)
      if (!std::isnan(numbers[i])) known.push_back(numbers[i]);
    stratum.sharpness.push_back(ComputeMedian(std::move(known)));
  }
  return stratum;
}

// A stored number of an answer that its user sees too; NaN: not known.
struct VisibleNumber {
  std::string name;
  std::function<double(const TrialRecord&)> of;
};

const std::vector<VisibleNumber>& VisibleNumbers() {
  using R = const TrialRecord&;
  static const std::vector<VisibleNumber> all = {
      {"matches", [](R r) { return 1.0 * r.num_matches; }},
      {"inliers", [](R r) { return 1.0 * r.num_inliers; }},
      {"inlier_share", [](R r) { return r.num_matches > 0 ? 1.0 * r.num_inliers / r.num_matches : kNaN; }},
      {"rotation_sd_deg", [](R r) { return r.density.rotation_sd_deg; }},
      {"direction_sd_deg", [](R r) { return r.density.direction_sd_deg; }},
      {"failure_probability", [](R r) { return StatedFailureProbability(r).value_or(kNaN); }}};
  return all;
}

VisibleAnswers MakeEmpty(const std::string& label) {
  VisibleAnswers answers;
  answers.label = label;
  answers.sharpness_names = {"sd_over_crb", "rotation_sd_deg", "direction_sd_deg"};
  for (const VisibleNumber& number : VisibleNumbers()) answers.seen_names.push_back(number.name);
  answers.seen.resize(answers.seen_names.size());
  answers.sharpness.resize(answers.sharpness_names.size());
  return answers;
}

void AddAnswer(const TrialRecord& record, std::int64_t cluster, VisibleAnswers* answers) {
  static const double nees_bound = ChiSquareQuantile(5, kNominalCoverage);
  if (record.status != MotionStatus::kOk || !IsCounted(record) || std::isnan(record.nees)) return;
  answers->clusters.push_back(cluster);
  answers->are_covered.push_back(record.nees <= nees_bound);
  for (size_t q = 0; q < answers->seen.size(); ++q)
    answers->seen[q].push_back(VisibleNumbers()[q].of(record));
  const StatedDensity& density = record.density;
  const double sharpness[] = {density.sd_over_crb, density.rotation_sd_deg, density.direction_sd_deg};
  for (size_t s = 0; s < std::size(sharpness); ++s) answers->sharpness[s].push_back(sharpness[s]);
}

std::vector<VisibleAnswers> CollectAnswers(const ResultStore& store, const RunDescription& run) {
  std::vector<VisibleAnswers> all;
  for (const DescribedEstimator& estimator : run.estimators) all.push_back(MakeEmpty(estimator.label));
  const TrialClusters clusters(run);
  store.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    if (problem.weight != 1.0)
      throw InputError(run.study + ": its trials are weighted; strata of counts say nothing of them");
    for (size_t e = 0; e < records.size(); ++e) AddAnswer(records[e], clusters.Find(problem), &all[e]);
  });
  return all;
}

}  // namespace

ClusteredShare MeasureShareOfClusters(const std::vector<bool>& holds,
                                      const std::vector<std::int64_t>& clusters) {
  const std::set<std::int64_t> different(clusters.begin(), clusters.end());
  ClusteredShare share;
  share.n = std::ssize(holds);
  share.count = std::ranges::count(holds, true);
  share.has_shared_clusters = std::ssize(different) < share.n;
  const std::vector<double> numbers(holds.begin(), holds.end());
  share.interval = share.has_shared_clusters
                       ? MeasureBoundedClusteredMean(numbers, {0.0, 1.0}, clusters).interval
                       : ExactBinomialInterval(share.count, share.n);
  return share;
}

std::vector<CoverageStratum> MeasureCoverageStrata(const VisibleAnswers& answers, StrataIntervals intervals) {
  std::vector<CoverageStratum> strata;
  for (size_t q = 0; q < answers.seen.size(); ++q) {
    std::vector<double> known;
    for (const double value : answers.seen[q])
      if (!std::isnan(value)) known.push_back(value);
    if (known.empty() || std::ranges::min(known) == std::ranges::max(known)) continue;
    const std::vector<double> cuts = FindCuts(known);
    std::vector<std::vector<size_t>> members(kNumQuarters + 1);  // index 0: unknown
    for (size_t i = 0; i < answers.seen[q].size(); ++i) {
      const double value = answers.seen[q][i];
      const auto place = std::ranges::lower_bound(cuts, value) - cuts.begin();
      members[std::isnan(value) ? 0 : static_cast<size_t>(place) + 1].push_back(i);
    }
    for (const int quarter : {1, 2, 3, 4, 0}) {
      const std::vector<size_t>& of_quarter = members[static_cast<size_t>(quarter)];
      if (!of_quarter.empty()) strata.push_back(MeasureStratum(answers, q, quarter, of_quarter, intervals));
    }
  }
  return strata;
}

CoverageStrata MeasureCoverageStrata(const ResultStore& store) {
  const RunDescription run = store.Description();
  CoverageStrata strata;
  strata.intervals = HasPopulationIntervals(run) ? StrataIntervals::kPopulation
                     : run.stopping_rule.empty() ? StrataIntervals::kClusters
                                                 : StrataIntervals::kAnytime;
  for (const VisibleAnswers& answers : CollectAnswers(store, run)) {
    strata.sharpness_names = answers.sharpness_names;
    for (CoverageStratum& stratum : MeasureCoverageStrata(answers, strata.intervals))
      strata.rows.push_back(std::move(stratum));
  }
  return strata;
}

}  // namespace rcme
