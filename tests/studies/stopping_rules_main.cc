// What the usual rules for the number of samples of RANSAC promise, and what they keep, over a population:
// the study behind results/stopping_promise.
//
// A rule stops once it has drawn log(1 - c) / log(1 - p) samples, c = 0.99 being the confidence and p the
// probability that a sample of m = 5 has no wrong match, of the best hypothesis so far with k inliers of n:
//   power:  p = (k / n)^m, as most libraries have it
//   exact:  p = prod_(i < m) (k - i) / (n - i), since a sample has no match twice
//   known:  the same with the true number of inliers, from the first sample on: what the promise is about
// Kept is the promise if a sample of true matches alone was among those drawn. The estimator is `standard`
// with the five-point solver; its inliers are those of its test at 95 %. Truth is in the analysis alone.
//   rcme_stopping_rules [draws, default 64] [trials per draw, default 20]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "estimator/estimator_registry.h"
#include "estimator/loop_inspection.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"
#include "stats/moments.h"
#include "stats/population_rate.h"

namespace rcme {
namespace {

constexpr double kConfidence = 0.99;
constexpr int kSampleSize = 5, kMostSamples = 5'000;

// Of a sample, with `num_inliers` of `num_matches`.
double ProbabilityOfPower(double num_inliers, double num_matches) {
  return std::pow(num_inliers / num_matches, kSampleSize);
}
double ProbabilityOfDraws(double num_inliers, double num_matches) {
  double probability = 1.0;
  for (int i = 0; i < kSampleSize; ++i) probability *= std::max(0.0, num_inliers - i) / (num_matches - i);
  return probability;
}

struct Rule {
  const char* name;
  double (*probability)(double num_inliers, double num_matches);
  bool knows_inliers;
};
constexpr Rule kRules[] = {{"power", ProbabilityOfPower, false},
                           {"exact", ProbabilityOfDraws, false},
                           {"known", ProbabilityOfDraws, true}};

// Where a rule stops in a trace, and what was drawn by then.
struct Stop {
  bool has_stopped = false, has_good_sample = false;
  int num_samples = 0;
};

Stop StopBy(const Rule& rule, const HypothesisTrace& trace, const std::vector<bool>& is_inlier) {
  const auto num_true = static_cast<int>(std::ranges::count(is_inlier, true));
  int best = rule.knows_inliers ? num_true : 0;
  Stop stop;
  for (const ScoredHypothesis& hypothesis : trace.hypotheses) {
    if (!rule.knows_inliers) best = std::max(best, hypothesis.score.num_inliers);
    if (!hypothesis.proposal.is_last) continue;
    ++stop.num_samples;
    const Sample& sample = hypothesis.proposal.id.sample;
    stop.has_good_sample = stop.has_good_sample || std::all_of(sample.begin(), sample.end(), [&](int match) {
                             return is_inlier[static_cast<size_t>(match)];
                           });
    const double probability = rule.probability(best, trace.num_matches);
    const double needed =
        probability >= 1.0 ? 1.0 : std::ceil(std::log1p(-kConfidence) / std::log1p(-probability));
    stop.has_stopped = stop.num_samples >= needed;
    if (stop.has_stopped) break;
  }
  return stop;
}

Study PopulationStudy(int num_draws, int num_trials) {
  Study study = ParseStudy(
      fmt::format("name: stopping_rules\nseed: 1\ntrials: {}\ndata: {{}}\n"
                  "conditions: {{population: hand_held_indoor, number: {}}}\n"
                  "estimators: [{{name: standard, options: {{solver: five_point, num_iterations: {}}}}}]\n",
                  num_trials, num_draws, kMostSamples),
      "stopping_rules.yaml");
  return study;
}

struct RuleCounts {
  std::vector<ConditionCount> broken;  // trials stopped without such a sample, by condition
  Moments num_samples;
  std::int64_t num_not_stopped = 0;
};

void Count(const HypothesisTrace& trace, const std::vector<bool>& is_inlier, std::uint32_t condition,
           std::vector<RuleCounts>* counts) {
  if (trace.hypotheses.empty()) return;  // refused before the loop
  for (size_t r = 0; r < std::size(kRules); ++r) {
    const Stop stop = StopBy(kRules[r], trace, is_inlier);
    (*counts)[r].num_not_stopped += !stop.has_stopped;
    if (!stop.has_stopped) continue;
    ConditionCount& broken = (*counts)[r].broken[condition];
    ++broken.num_trials;
    broken.num_events += !stop.has_good_sample;
    (*counts)[r].num_samples.Add(stop.num_samples);
  }
}

void Measure(int num_draws, int num_trials) {
  const StudyPlan plan = MakePlan(PopulationStudy(num_draws, num_trials));
  const LoopInspection& loop = *FindInspection(*plan.estimators.front());
  std::vector<RuleCounts> counts(std::size(kRules),
                                 {std::vector<ConditionCount>(plan.conditions.size()), {}, 0});
  std::int64_t num_not_simulated = 0;
  for (const Condition& condition : plan.conditions) {
    for (std::uint32_t trial = 0; trial < static_cast<std::uint32_t>(num_trials); ++trial) {
      const StreamName name = NameOfTrial(plan, condition, trial);
      try {
        const TrialData data = condition.source->Make(name);
        RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
        Count(loop.Trace(data.problem, rng), data.truth.is_inlier_true, condition.index, &counts);
      } catch (const NotSimulated&) {
        ++num_not_simulated;
      }
    }
  }
  fmt::print("rule,n,conditions,not_simulated,not_stopped,broken,lower,upper,mean_samples\n");
  for (size_t r = 0; r < std::size(kRules); ++r) {
    const PopulationRate rate = MeasurePopulationRate(counts[r].broken);
    fmt::print("{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.1f}\n", kRules[r].name, rate.n, rate.num_conditions,
               num_not_simulated, counts[r].num_not_stopped, rate.value, rate.interval.lower,
               rate.interval.upper, counts[r].num_samples.mean());
  }
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  rcme::Measure(argc > 1 ? std::atoi(argv[1]) : 64, argc > 2 ? std::atoi(argv[2]) : 20);
}
