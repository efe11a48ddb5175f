#include "experiments/real/truth_free/covariance_test.h"

#include <algorithm>
#include <cmath>

#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

constexpr double kTestConfidence = 0.95;
constexpr int kTestResamples = 1000;

using ValueList = std::vector<double> UnitValues::*;

// Ratio of the median of a list to the median of chi-square.
ComparedMedians CompareWithChiSquare(std::span<const TestUnit> units, ValueList list, int degrees_of_freedom,
                                     RandomStream& rng) {
  const double median = ChiSquareQuantile(degrees_of_freedom, 0.5);
  std::vector<UnitValues> against;
  for (const TestUnit& unit : units) against.push_back({unit.values.*list, {median}});
  return RatioOfMedians(against, kTestConfidence, kTestResamples, rng);
}

SharedMemberRate MeasureCoverage(std::span<const TestUnit> units, ValueList list, int degrees_of_freedom) {
  const double bound = ChiSquareQuantile(degrees_of_freedom, 0.95);
  std::vector<PairEvent> events;
  for (const TestUnit& unit : units) {
    for (const double value : unit.values.*list)
      events.push_back({unit.member1, unit.member2, value <= bound});
  }
  SharedMemberRate coverage = MeasureSharedMemberRate(events, kTestConfidence);
  if (coverage.num_members < 2) coverage.interval = {0.0, 1.0};  // how much they share cannot be seen
  return coverage;
}

bool IsNominal(const ComparedMedians& ratio) { return VerdictOn(ratio) == TruthFreeVerdict::kHolds; }

FaultCause FindFaultCause(bool is_of_data, bool is_of_estimator) {
  if (is_of_data && is_of_estimator) return FaultCause::kBoth;
  if (is_of_data) return FaultCause::kData;
  return is_of_estimator ? FaultCause::kEstimator : FaultCause::kNone;
}

// Intervals shrink with the root of the number of units.
double UnitsNeeded(const ComparedMedians& ratio, int num_units) {
  const double value = std::log(ratio.value), nominal = std::log(kNominalVariance);
  const double below = value - std::log(ratio.interval.lower), above = std::log(ratio.interval.upper) - value;
  // Factors by which the interval must shrink to be nominal, and to exclude one.
  const double to_hold = std::max(below / (nominal + value), above / (nominal - value));
  const double to_be_wrong = value > 0.0 ? below / value : above / -value;
  const double shrink = std::abs(value) < nominal ? std::min(to_hold, to_be_wrong) : to_be_wrong;
  return std::isfinite(shrink) ? std::ceil(num_units * std::max(1.0, shrink * shrink)) : kNaN;
}

}  // namespace

TruthFreeVerdict VerdictOn(const ComparedMedians& ratio) {
  if (std::isnan(ratio.value)) return TruthFreeVerdict::kNoData;
  const Interval of_covariances = {1.0 / ratio.interval.upper, 1.0 / ratio.interval.lower};
  return VerdictOnInterval(of_covariances, 1.0, {1.0 / kNominalVariance, kNominalVariance});
}

double LeastNominalCoverage(int degrees_of_freedom) {
  return ChiSquareCdf(degrees_of_freedom, ChiSquareQuantile(degrees_of_freedom, 0.95) / kNominalVariance);
}

void JudgeCovariances(TruthFreeTest* test) {
  test->verdict = TruthFreeVerdict::kUndecided;
  test->cause = FaultCause::kNone;
  test->units_needed = kNaN;
  if (std::isnan(test->ratio.value)) {
    test->verdict = TruthFreeVerdict::kNoData;
    return;
  }
  const double least = LeastNominalCoverage(test->degrees_of_freedom);
  const Interval &ratio = test->ratio.interval, &twins = test->against_twins.interval,
                 &simulated = test->in_simulation.interval, &covered = test->coverage.interval,
                 &twins_covered = test->twin_coverage.interval;
  const bool covers_too_little = covered.upper < least;
  if (covers_too_little || (ratio.lower > 1.0 && !IsNominal(test->ratio))) {
    const bool is_worse_than_twins = covered.upper < twins_covered.lower;
    const bool is_worse_in_simulation = twins_covered.upper < least;
    test->cause = FindFaultCause(twins.lower > 1.0 || is_worse_than_twins,
                                 simulated.lower > kApproximation || is_worse_in_simulation);
    if (test->cause != FaultCause::kNone) test->verdict = TruthFreeVerdict::kTooSmall;
  } else if (IsNominal(test->ratio)) {
    if (test->coverage.rate >= least) test->verdict = TruthFreeVerdict::kHolds;
  } else if (ratio.upper < 1.0) {
    test->cause = FindFaultCause(twins.upper < 1.0, simulated.upper < 1.0 / kApproximation);
    if (test->cause != FaultCause::kNone) test->verdict = TruthFreeVerdict::kTooLarge;
  }
  if (test->verdict == TruthFreeVerdict::kUndecided)
    test->units_needed = UnitsNeeded(test->ratio, test->num_units);
}

TruthFreeTest TestCovariances(std::string name, int degrees_of_freedom, std::span<const TestUnit> units,
                              RandomStream& rng) {
  TruthFreeTest test;
  test.name = std::move(name);
  test.degrees_of_freedom = degrees_of_freedom;
  std::vector<UnitValues> values;
  for (const TestUnit& unit : units) {
    test.num_units += !unit.values.observed.empty();
    test.num_values += static_cast<int>(unit.values.observed.size());
    values.push_back(unit.values);
  }
  test.coverage = MeasureCoverage(units, &UnitValues::observed, degrees_of_freedom);
  test.twin_coverage = MeasureCoverage(units, &UnitValues::null, degrees_of_freedom);
  test.ratio = CompareWithChiSquare(units, &UnitValues::observed, degrees_of_freedom, rng);
  test.in_simulation = CompareWithChiSquare(units, &UnitValues::null, degrees_of_freedom, rng);
  test.against_twins = RatioOfMedians(values, kTestConfidence, kTestResamples, rng);
  JudgeCovariances(&test);
  return test;
}

CovarianceVerdict JudgeTests(const std::vector<TruthFreeTest>& tests) {
  const auto with = [&](TruthFreeVerdict verdict) {
    CovarianceVerdict found{verdict, FaultCause::kNone, {}};
    bool is_of_data = false, is_of_estimator = false;
    for (const TruthFreeTest& test : tests) {
      const bool says_nothing = verdict == TruthFreeVerdict::kTooLarge && test.name != "spatial_halves" &&
                                test.name != kSimulationTest;
      if (test.verdict != verdict || says_nothing) continue;
      found.tests.push_back(test.name);
      is_of_data |= test.cause == FaultCause::kData || test.cause == FaultCause::kBoth;
      is_of_estimator |= test.cause == FaultCause::kEstimator || test.cause == FaultCause::kBoth;
    }
    found.cause = FindFaultCause(is_of_data, is_of_estimator);
    return found;
  };
  for (const TruthFreeVerdict verdict : {TruthFreeVerdict::kTooSmall, TruthFreeVerdict::kTooLarge,
                                         TruthFreeVerdict::kUndecided, TruthFreeVerdict::kHolds}) {
    CovarianceVerdict found = with(verdict);
    if (!found.tests.empty()) return found;
  }
  return {};
}

}  // namespace rcme
