#include "experiments/truth_free/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/base/stop_request.h"
#include "experiments/data/data_source.h"
#include "experiments/trial/answer_check.h"
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

// A pair, or a twin of it, with its answer.
struct Answered {
  NamedPair pair;
  MotionEstimate estimate;
  bool IsOk() const { return estimate.status == MotionStatus::kOk; }
};

Answered Ask(NamedPair pair, const MotionEstimator& estimator, const StreamName& name) {
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  MotionEstimate estimate = Judged(estimator.Estimate(pair.problem, rng), pair.problem.matches.size());
  return {std::move(pair), std::move(estimate)};
}

// What is computed of each pair and its twins.
struct PairResults {
  Answered whole;
  std::vector<Answered> twins;
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

PairResults ResultsOf(const NamedPair& pair, const MotionEstimator& estimator,
                      const ValidationOptions& options) {
  constexpr std::uint32_t kCallsOfOne = 8;  // numbers of trials: a pair's own calls, then those of each twin
  StreamName name{options.seed, StreamKeyOf(pair.name), 0, 0};
  PairResults results{Ask(pair, estimator, name), {}, {}, {}, {}, {}};
  if (!results.whole.IsOk()) return results;
  AddHalves(results.whole, estimator, name, &results.spatial.observed, &results.random.observed);
  results.products = ProductsOf(pair.problem, results.whole.estimate);
  for (int k = 1; k <= options.num_twins; ++k) {
    const auto twin = static_cast<std::uint32_t>(k);
    name.trial = twin * kCallsOfOne;
    results.twins.push_back(Ask(TwinOf(pair, results.whole.estimate, options.seed, twin), estimator, name));
    if (!results.twins.back().IsOk()) continue;
    AddHalves(results.twins.back(), estimator, name, &results.spatial.null, &results.random.null);
    results.twin_products += ProductsOf(results.twins.back().pair.problem, results.twins.back().estimate);
  }
  return results;
}

// Of each triple its closure and those of its twins. A pair that is in several triples makes these dependent.
std::vector<UnitValues> Closures(const std::vector<PairResults>& results, const std::vector<Triple>& triples,
                                 int num_twins) {
  std::vector<UnitValues> closures;
  for (const Triple& triple : triples) {
    const PairResults &ab = results[triple.ab], &bc = results[triple.bc], &ac = results[triple.ac];
    if (!ab.whole.IsOk() || !bc.whole.IsOk() || !ac.whole.IsOk()) continue;
    UnitValues values;
    const auto add = [](const Answered& a, const Answered& b, const Answered& c,
                        const Eigen::Vector3d& expected, std::vector<double>* to) {
      if (!a.IsOk() || !b.IsOk() || !c.IsOk()) return;
      const std::optional<double> closure =
          NormalizedClosure({&a.pair, &a.estimate}, {&b.pair, &b.estimate}, {&c.pair, &c.estimate}, expected);
      if (closure) to->push_back(*closure);
    };
    add(ab.whole, bc.whole, ac.whole, Eigen::Vector3d::Zero(), &values.observed);
    const Eigen::Vector3d of_truth = ClosureOf(ab.whole.estimate, bc.whole.estimate, ac.whole.estimate);
    for (size_t k = 0; k < static_cast<size_t>(num_twins); ++k)
      add(ab.twins[k], bc.twins[k], ac.twins[k], of_truth, &values.null);
    closures.push_back(std::move(values));
  }
  return closures;
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

ComparedMedians SigmaOf(const std::vector<PairResults>& results, RandomStream& rng) {
  std::vector<UnitValues> units;
  for (const PairResults& one : results) {
    if (one.whole.IsOk()) units.push_back({{NoiseOf(one.whole.pair.problem, one.whole.estimate)}, {1.0}});
  }
  return RatioOfMedians(units, kConfidence, kResamples, rng);
}

const TruthFreeTest& Named(const SetReport& report, const std::string& name) {
  return *std::ranges::find(report.tests, name, &TruthFreeTest::name);
}

std::vector<std::string> AdviceOn(const SetReport& report) {
  std::vector<std::string> advice;
  const auto is_small = [&](const char* name) {
    return Named(report, name).verdict == TruthFreeVerdict::kTooSmall;
  };
  const bool is_correlated_far = std::ranges::any_of(report.correlations, [](const DistanceCorrelation& c) {
    return c.from_px >= 1.0 && c.difference.lower > kNominalCorrelation;
  });
  if (is_small("random_halves"))
    advice.emplace_back(
        "random halves differ more than independent errors explain: wrong matches among the inliers, or an "
        "assumed "
        "sigma that is too small (an estimator that estimates it, covariance=robust)");
  if (report.correlations.front().difference.lower > kNominalCorrelation)
    advice.emplace_back(
        "points within 1 px of each other err alike: one point found twice; covariance=robust counts it "
        "once");
  if (is_correlated_far)
    advice.emplace_back("neighbours err alike: covariance=robust widens by what image blocks show");
  if (is_small("spatial_halves") && !is_small("random_halves"))
    advice.push_back(fmt::format(
        "halves of the image disagree: with covariance=robust, covariance_factor={:.2g} times its present "
        "value; {}",
        Named(report, "spatial_halves").ratio.value,
        is_correlated_far ? "neighbours' errors are part of it"
                          : "no correlation up to 64 px: look at calibration, distortion, rolling shutter "
                            "(focal_sd, principal_point_sd_px, distortion_sd)"));
  if (Named(report, "random_halves").verdict == TruthFreeVerdict::kTooLarge &&
      Named(report, "spatial_halves").verdict != TruthFreeVerdict::kTooLarge)
    advice.emplace_back(
        "random halves differ less than the covariances say, halves of the image do not: what neighbours' "
        "errors have "
        "in common is in both random halves and cancels; no reason to narrow the covariances");
  if (is_small("closure"))
    advice.push_back(
        fmt::format("rotations around three images do not close: too small by {:.2g} in variance; if "
                    "halves hold, an error that is common to a whole image, as of its calibration",
                    Named(report, "closure").ratio.value));
  if (report.sigma_px.interval.upper < 0.8 * report.assumed_sigma_px ||
      report.sigma_px.interval.lower > 1.25 * report.assumed_sigma_px)
    advice.push_back(fmt::format("assumed sigma {:g} px, the residuals say {:.2g}: assume that (--sigma)",
                                 report.assumed_sigma_px, report.sigma_px.value));
  return advice;
}

}  // namespace

TruthFreeVerdict VerdictOn(const ComparedMedians& ratio) {
  if (std::isnan(ratio.value)) return TruthFreeVerdict::kNoData;
  const Interval& interval = ratio.interval;
  if (interval.lower >= 1.0 / kNominalVariance && interval.upper <= kNominalVariance)
    return TruthFreeVerdict::kHolds;
  if (interval.lower > 1.0) return TruthFreeVerdict::kTooSmall;
  if (interval.upper < 1.0) return TruthFreeVerdict::kTooLarge;
  return TruthFreeVerdict::kUndecided;
}

SetReport Validate(const PairSet& set, const MotionEstimator& estimator, const ValidationOptions& options) {
  SetReport report;
  report.name = set.name;
  report.num_pairs = static_cast<int>(set.pairs.size());
  std::vector<PairResults> results;
  std::vector<UnitValues> spatial, random;
  for (const NamedPair& pair : set.pairs) {
    if (IsStopRequested()) throw Stopped("stopped; nothing is written");
    results.push_back(ResultsOf(pair, estimator, options));
    report.num_answered += results.back().whole.IsOk();
    spatial.push_back(results.back().spatial);
    random.push_back(results.back().random);
  }
  const std::vector<Triple> triples = FindTriples(set.pairs);
  const std::vector<UnitValues> closures = Closures(results, triples, options.num_twins);
  report.num_triples = static_cast<int>(closures.size());
  RandomStream rng = StreamFor({options.seed, StreamKeyOf(set.name), 0, 0}, StreamPurpose::kMonteCarlo);
  report.tests = {TestOf("spatial_halves", 5, spatial, rng), TestOf("random_halves", 5, random, rng),
                  TestOf("closure", 3, closures, rng)};
  report.assumed_sigma_px = set.pairs.empty() ? kNaN : set.pairs.front().problem.sigma_px;
  report.sigma_px = SigmaOf(results, rng);
  report.correlations = CorrelationsOf(results, rng);
  report.advice = AdviceOn(report);
  return report;
}

}  // namespace rcme
