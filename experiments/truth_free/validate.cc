#include "experiments/truth_free/validate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/base/stop_request.h"
#include "experiments/data/data_source.h"
#include "experiments/trial/answer_check.h"
#include "experiments/truth_free/advice.h"
#include "experiments/truth_free/closure.h"
#include "experiments/truth_free/halves.h"
#include "experiments/truth_free/residual_correlation.h"
#include "experiments/truth_free/twin.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

constexpr double kConfidence = 0.95;
constexpr int kResamples = 1000;
constexpr double kLeastProducts = 100.0;  // of residuals, for a correlation
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Answered Ask(NamedPair pair, const MotionEstimator& estimator, const StreamName& name) {
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  MotionEstimate estimate = Judged(estimator.Estimate(pair.problem, rng), pair.problem.matches.size());
  return {std::move(pair), std::move(estimate)};
}

// What is computed of each pair and its twins.
struct PairResults {
  UnitValues spatial, random;
  ResidualProducts products, twin_products;
};

void AddHalves(const Answered& answered, const MotionEstimator& estimator, StreamName name,
               std::vector<double>* spatial, std::vector<double>* random) {
  const auto add = [&](Split split, std::vector<double>* values) {
    ++name.trial;
    const std::optional<double> difference =
        DifferenceOfHalves(answered.pair.problem, answered.estimate, split, estimator, name);
    if (difference) values->push_back(*difference);
  };
  for (const Split split : kSpatialSplits) add(split, spatial);
  for (const Split split : kRandomSplits) add(split, random);
}

// Answers a pair and its twins too.
PairResults ResultsOf(const NamedPair& pair, const MotionEstimator& estimator,
                      const ValidationOptions& options, PairAnswers* answers) {
  constexpr std::uint32_t kCallsOfOne = 8;  // numbers of trials: a pair's own calls, then those of each twin
  StreamName name{options.seed, StreamKeyOf(pair.name), 0, 0};
  PairResults results;
  answers->whole = Ask(pair, estimator, name);
  const Answered& whole = answers->whole;
  if (!whole.IsOk()) return results;
  AddHalves(whole, estimator, name, &results.spatial.observed, &results.random.observed);
  results.products = ProductsOf(pair.problem, whole.estimate);
  for (int k = 1; k <= options.num_twins; ++k) {
    const auto number = static_cast<std::uint32_t>(k);
    name.trial = number * kCallsOfOne;
    answers->twins.push_back(Ask(TwinOf(pair, whole.estimate, options.seed, number), estimator, name));
    const Answered& twin = answers->twins.back();
    if (!twin.IsOk()) continue;
    AddHalves(twin, estimator, name, &results.spatial.null, &results.random.null);
    results.twin_products += ProductsOf(twin.pair.problem, twin.estimate);
  }
  return results;
}

std::map<size_t, int> CountLoops(const std::vector<Loop>& loops, const std::vector<PairAnswers>& answers) {
  std::map<size_t, int> counts;
  for (const Loop& loop : loops) {
    const bool is_answered =
        std::ranges::all_of(loop, [&](const LoopStep& step) { return answers[step.pair].whole.IsOk(); });
    if (is_answered) ++counts[loop.size()];
  }
  return counts;
}

double ShareWithin(std::span<const UnitValues> units, std::vector<double> UnitValues::*list, double bound) {
  double num_within = 0.0, n = 0.0;
  for (const UnitValues& unit : units) {
    for (const double value : unit.*list) num_within += value <= bound, n += 1.0;
  }
  return n > 0.0 ? num_within / n : kNaN;
}

double MedianOfNull(std::span<const UnitValues> units) {
  std::vector<double> all;
  for (const UnitValues& unit : units) all.insert(all.end(), unit.null.begin(), unit.null.end());
  return MedianOf(std::move(all));
}

TruthFreeTest TestOf(std::string name, int degrees_of_freedom, const std::vector<UnitValues>& units,
                     RandomStream& rng) {
  TruthFreeTest test;
  test.name = std::move(name);
  test.degrees_of_freedom = degrees_of_freedom;
  for (const UnitValues& unit : units) test.num_values += static_cast<int>(unit.observed.size());
  const double bound = ChiSquareQuantile(degrees_of_freedom, 0.95);
  test.coverage = ShareWithin(units, &UnitValues::observed, bound);
  test.twin_coverage = ShareWithin(units, &UnitValues::null, bound);
  test.ratio = RatioOfMedians(units, kConfidence, kResamples, rng);
  const double conservative = std::min(1.0, MedianOfNull(units) / ChiSquareQuantile(degrees_of_freedom, 0.5));
  for (double* x : {&test.ratio.value, &test.ratio.interval.lower, &test.ratio.interval.upper})
    *x *= conservative;
  test.verdict = VerdictOn(test.ratio);
  return test;
}

std::vector<DistanceCorrelation> CorrelationsOf(const std::vector<PairResults>& results, RandomStream& rng) {
  std::vector<DistanceCorrelation> all;
  const auto sum_of = [](const std::vector<const PairResults*>& chosen, ResidualProducts PairResults::*list) {
    ResidualProducts sum;
    for (const PairResults* one : chosen) sum += one->*list;
    return sum;
  };
  std::vector<const PairResults*> chosen;
  for (const PairResults& one : results) chosen.push_back(&one);
  const ResidualProducts of_pairs = sum_of(chosen, &PairResults::products),
                         of_twins = sum_of(chosen, &PairResults::twin_products);
  std::vector<std::vector<double>> resampled(kNumDistances);
  for (int resample = 0; resample < kResamples && !results.empty(); ++resample) {
    for (const PairResults*& one : chosen)
      one = &results[rng.IntegerBelow(static_cast<std::uint32_t>(results.size()))];
    const ResidualProducts a = sum_of(chosen, &PairResults::products),
                           b = sum_of(chosen, &PairResults::twin_products);
    for (size_t k = 0; k < kNumDistances; ++k) {
      const double difference = a.Correlation(k) - b.Correlation(k);
      if (std::isfinite(difference)) resampled[k].push_back(difference);
    }
  }
  for (size_t k = 0; k < kNumDistances; ++k) {
    DistanceCorrelation of{kDistanceEdgesPx[k],     kDistanceEdgesPx[k + 1], of_pairs.counts[k],
                           of_pairs.Correlation(k), of_twins.Correlation(k), {kNaN, kNaN}};
    if (of.num_products >= kLeastProducts && !resampled[k].empty()) {
      std::ranges::sort(resampled[k]);
      const auto last = static_cast<double>(resampled[k].size() - 1);
      of.difference = {resampled[k][static_cast<size_t>(0.025 * last + 0.5)],
                       resampled[k][static_cast<size_t>(0.975 * last + 0.5)]};
    }
    all.push_back(of);
  }
  return all;
}

ComparedMedians SigmaOf(const std::vector<PairAnswers>& answers, RandomStream& rng) {
  std::vector<UnitValues> units;
  for (const auto& [whole, twins] : answers) {
    if (whole.IsOk()) units.push_back({{NoiseOf(whole.pair.problem, whole.estimate)}, {1.0}});
  }
  return RatioOfMedians(units, kConfidence, kResamples, rng);
}

}  // namespace

TruthFreeVerdict VerdictOn(const ComparedMedians& ratio) {
  if (std::isnan(ratio.value)) return TruthFreeVerdict::kNoData;
  const Interval of_covariances = {1.0 / ratio.interval.upper, 1.0 / ratio.interval.lower};
  return VerdictOnInterval(of_covariances, 1.0, {1.0 / kNominalVariance, kNominalVariance});
}

SetReport Validate(const PairSet& set, const MotionEstimator& estimator, const ValidationOptions& options) {
  SetReport report;
  report.name = set.name;
  report.num_pairs = static_cast<int>(set.pairs.size());
  std::vector<PairAnswers> answers;
  std::vector<PairResults> results;
  std::vector<UnitValues> spatial, random;
  for (const NamedPair& pair : set.pairs) {
    if (IsStopRequested()) throw Stopped("stopped; nothing is written");
    results.push_back(ResultsOf(pair, estimator, options, &answers.emplace_back()));
    report.num_answered += answers.back().whole.IsOk();
    spatial.push_back(results.back().spatial);
    random.push_back(results.back().random);
  }
  const std::vector<Loop> loops = FindLoops(set.pairs);
  report.num_loops = CountLoops(loops, answers);
  RandomStream rng = StreamFor({options.seed, StreamKeyOf(set.name), 0, 0}, StreamPurpose::kMonteCarlo);
  report.tests = {TestOf("spatial_halves", 5, spatial, rng), TestOf("random_halves", 5, random, rng),
                  TestOf("closure", 3, ClosuresOf(answers, loops, RotationClosure), rng),
                  TestOf("directions", 1, ClosuresOf(answers, loops, DirectionClosure), rng)};
  report.assumed_sigma_px = set.pairs.empty() ? kNaN : set.pairs.front().problem.sigma_px;
  report.sigma_px = SigmaOf(answers, rng);
  report.correlations = CorrelationsOf(results, rng);
  report.calibration = TestCalibration(answers);
  report.sizes = TestKeyPointSizes(answers);
  report.advice = AdviceOn(report);
  return report;
}

}  // namespace rcme
