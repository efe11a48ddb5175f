#include "experiments/real/truth_free/validate.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "estimator/robust_covariance/disjoint_sets.h"
#include "experiments/data/data_source.h"
#include "experiments/real/truth_free/advice.h"
#include "experiments/real/truth_free/closure.h"
#include "experiments/real/truth_free/halves.h"
#include "experiments/real/truth_free/kept_answers.h"
#include "experiments/real/truth_free/residual_pattern.h"
#include "experiments/real/truth_free/self_calibration.h"
#include "experiments/real/truth_free/twin.h"
#include "experiments/trial/answer_check.h"
#include "stats/consistency.h"
#include "stats/constants.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

// An assumed sigma is nominal if the ratio of the estimated one to it lies in this range.
constexpr Interval kNominalSigma = {0.8, 1.25};
constexpr double kConfidence = 0.95;
constexpr int kResamples = 1000;          // of pairs
constexpr double kLeastProducts = 100.0;  // of residuals, for a correlation

Answered Ask(NamedPair pair, const MotionEstimator& estimator, const StreamName& name) {
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  MotionEstimate estimate = Judged(estimator.Estimate(pair.problem, rng), pair.problem.matches.size());
  return {std::move(pair), std::move(estimate)};
}

// The results for one pair and its twins.
struct PairResults {
  PairAnswers answers;
  UnitValues spatial, random;
  std::vector<double> twin_errors;  // normalised and squared, of the twins' answers against their truth
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

PairResults ComputePairResults(const NamedPair& pair, const MotionEstimator& estimator,
                               const ValidationOptions& options) {
  constexpr std::uint32_t kCallsOfPair = 8;  // numbers of trials: a pair's own calls, then those of each twin
  StreamName name{options.seed, HashToStreamKey(pair.name), 0, 0};
  PairResults results;
  results.answers.whole = Ask(pair, estimator, name);
  const Answered& whole = results.answers.whole;
  if (!whole.IsOk()) return results;
  AddHalves(whole, estimator, name, &results.spatial.observed, &results.random.observed);
  results.products = SumProducts(pair.problem, whole.estimate);
  for (int k = 1; k <= options.num_twins; ++k) {
    const auto number = static_cast<std::uint32_t>(k);
    name.trial = number * kCallsOfPair;
    results.answers.twins.push_back(
        Ask(MakeTwin(pair, whole.estimate, options.seed, number, options.field), estimator, name));
    const Answered& twin = results.answers.twins.back();
    if (!twin.IsOk()) continue;
    AddHalves(twin, estimator, name, &results.spatial.null, &results.random.null);
    results.twin_errors.push_back(
        NormalizedErrorSquared(LocalCoordinates(twin.estimate.cam2_from_cam1, whole.estimate.cam2_from_cam1),
                               twin.estimate.pose_cov));
    results.twin_products += SumProducts(twin.pair.problem, twin.estimate);
  }
  return results;
}

std::string ResultsAsJson(const PairResults& results) {
  Json twins = Json::array();
  for (const Answered& twin : results.answers.twins) twins.push_back(AnswerAsJson(twin.estimate));
  return Json::array({AnswerAsJson(results.answers.whole.estimate), std::move(twins),
                      NumbersAsJson(results.spatial.observed), NumbersAsJson(results.spatial.null),
                      NumbersAsJson(results.random.observed), NumbersAsJson(results.random.null),
                      NumbersAsJson(results.twin_errors), ProductsAsJson(results.products),
                      ProductsAsJson(results.twin_products)})
      .dump();
}

// Twins are not stored: their matches are made again.
PairResults ResultsFrom(const std::string& text, const NamedPair& pair, const ValidationOptions& options) {
  const Json json = ParsePiece(text);
  RequireSize(json, 9);
  const size_t num_matches = pair.problem.matches.size();
  PairResults results;
  results.answers.whole = {pair, AnswerFrom(json[0], num_matches)};
  const Answered& whole = results.answers.whole;
  RequireSize(json[1], whole.IsOk() ? static_cast<size_t>(options.num_twins) : 0);
  for (const Json& answer : json[1]) {
    const auto number = static_cast<std::uint32_t>(results.answers.twins.size()) + 1;
    results.answers.twins.push_back({MakeTwin(pair, whole.estimate, options.seed, number, options.field),
                                     AnswerFrom(answer, num_matches)});
  }
  results.spatial = {NumbersFrom(json[2]), NumbersFrom(json[3])};
  results.random = {NumbersFrom(json[4]), NumbersFrom(json[5])};
  results.twin_errors = NumbersFrom(json[6]);
  results.products = ProductsFrom(json[7]);
  results.twin_products = ProductsFrom(json[8]);
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

// Groups loops that have a pair in common, directly or through other loops.
std::vector<std::int64_t> GroupLoops(const std::vector<Loop>& loops, size_t num_pairs) {
  DisjointSets sets(num_pairs);
  for (const Loop& loop : loops) {
    for (const LoopStep& step : loop) sets.Unite(loop.front().pair, step.pair);
  }
  std::vector<std::int64_t> groups;
  for (const Loop& loop : loops) groups.push_back(static_cast<std::int64_t>(sets.Find(loop.front().pair)));
  return groups;
}

std::vector<TestUnit> CloseLoops(const std::vector<PairAnswers>& answers, const std::vector<Loop>& loops,
                                 LoopErrorOf error_of) {
  const std::vector<std::int64_t> groups = GroupLoops(loops, answers.size());
  std::vector<TestUnit> units;
  for (size_t k = 0; k < loops.size(); ++k) {
    for (UnitValues& values : ComputeClosures(answers, {loops[k]}, error_of))
      units.push_back({groups[k], groups[k], std::move(values)});
  }
  return units;
}

std::vector<DistanceCorrelation> MeasureCorrelations(const std::vector<PairResults>& results,
                                                     RandomStream& rng) {
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

ComparedMedians CompareSigma(const std::vector<PairAnswers>& answers, RandomStream& rng) {
  std::vector<UnitValues> units;
  for (const auto& [whole, twins] : answers) {
    if (whole.IsOk()) units.push_back({{EstimateNoise(whole.pair.problem, whole.estimate)}, {1.0}});
  }
  return RatioOfMedians(units, kConfidence, kResamples, rng);
}

// The assumed sigma is wrong only if the whole interval lies outside the nominal range.
TruthFreeVerdict JudgeSigma(const ComparedMedians& estimated_px, double assumed_px) {
  if (std::isnan(estimated_px.value)) return TruthFreeVerdict::kNoData;
  const Interval ratio = {estimated_px.interval.lower / assumed_px, estimated_px.interval.upper / assumed_px};
  if (ratio.lower > kNominalSigma.upper) return TruthFreeVerdict::kTooSmall;
  if (ratio.upper < kNominalSigma.lower) return TruthFreeVerdict::kTooLarge;
  const bool is_nominal = ratio.lower >= kNominalSigma.lower && ratio.upper <= kNominalSigma.upper;
  return is_nominal ? TruthFreeVerdict::kHolds : TruthFreeVerdict::kUndecided;
}

void SetSharpness(const std::vector<PairAnswers>& answers, SetReport* report) {
  std::vector<double> rotation, direction;
  for (const PairAnswers& pair : answers) {
    if (!pair.whole.IsOk()) continue;
    const Matrix5d& cov = pair.whole.estimate.pose_cov;
    rotation.push_back(kDegPerRad * std::sqrt(cov.topLeftCorner<3, 3>().trace()));
    direction.push_back(kDegPerRad * std::sqrt(cov.bottomRightCorner<2, 2>().trace()));
  }
  report->rotation_sd_deg = ComputeMedian(std::move(rotation));
  report->direction_sd_deg = ComputeMedian(std::move(direction));
}

}  // namespace

SetReport Validate(const PairSet& set, const MotionEstimator& estimator, const ValidationOptions& options,
                   KeptSteps* steps) {
  SetReport report;
  report.name = set.name;
  report.num_pairs = static_cast<int>(set.pairs.size());
  std::vector<PairAnswers> answers;
  std::vector<PairResults> results;
  std::vector<TestUnit> simulation, spatial, random;
  for (const NamedPair& pair : set.pairs) {
    results.push_back(TakeStep<PairResults>(
        steps, [&] { return ComputePairResults(pair, estimator, options); },
        {ResultsAsJson, [&](const std::string& json) { return ResultsFrom(json, pair, options); }}));
    answers.push_back(std::move(results.back().answers));
    report.num_answered += answers.back().whole.IsOk();
  }
  const std::vector<ImageNumbers> images = NumberImages(answers);
  for (size_t i = 0; i < results.size(); ++i) {
    const auto [image1, image2] = images[i];
    simulation.push_back({image1, image2, {results[i].twin_errors, results[i].twin_errors}});
    spatial.push_back({image1, image2, results[i].spatial});
    random.push_back({image1, image2, results[i].random});
  }
  const std::vector<Loop> loops = FindLoops(set.pairs);
  report.num_loops = CountLoops(loops, answers);
  RandomStream rng = StreamFor({options.seed, HashToStreamKey(set.name), 0, 0}, StreamPurpose::kMonteCarlo);
  report.tests = {TestCovariances("spatial_halves", 5, spatial, rng),
                  TestCovariances("random_halves", 5, random, rng),
                  TestCovariances("closure", 3, CloseLoops(answers, loops, RotationClosure), rng),
                  TestCovariances("directions", 1, CloseLoops(answers, loops, DirectionClosure), rng),
                  TestCovariances(kSimulationTest, 5, simulation, rng)};
  report.covariances = JudgeTests(report.tests);
  SetSharpness(answers, &report);
  report.assumed_sigma_px = set.pairs.empty() ? kNaN : set.pairs.front().problem.sigma_px;
  report.sigma_px = CompareSigma(answers, rng);
  report.sigma_verdict = JudgeSigma(report.sigma_px, report.assumed_sigma_px);
  report.correlations = MeasureCorrelations(results, rng);
  report.calibration = Calibrate(answers, estimator, options.seed, steps);
  report.sizes = TestKeyPointSizes(answers);
  report.closures = MeasureClosureByLength(answers, options.longest_loop);
  report.advice = FindReasons(report);
  return report;
}

}  // namespace rcme
