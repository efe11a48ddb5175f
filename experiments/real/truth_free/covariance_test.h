// Tests stated covariances on the pairs and on simulated twins of the pairs.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "experiments/real/truth_free/truth_free_verdict.h"
#include "stats/median_ratio.h"
#include "stats/random.h"
#include "stats/shared_members.h"

namespace rcme {

// A variance that is wrong by less than this factor is nominal. It is 22 % in standard deviation.
inline constexpr double kNominalVariance = 1.5;
// Halves and closures are chi-square to first order only. The errors of twins are independent and normal, so
// a median of theirs that is off by less than this factor is not counted as a fault of the estimator.
inline constexpr double kApproximation = 1.25;

// Normalised squared differences of one pair or one loop of pairs, and of its twins. Units with a common
// member are not independent (shared_members.h).
struct TestUnit {
  std::int64_t member1 = 0, member2 = 0;
  UnitValues values;
};

// Source of a fault. kData: only the pairs show it. kEstimator: the twins show it too, although their errors
// are as the estimator assumes.
enum class FaultCause { kNone, kData, kEstimator, kBoth };

// Name of the test that compares estimates on twins with their true motion.
inline constexpr const char* kSimulationTest = "simulation";

// A test of the covariances. Ratios of variances are above one if covariances are too small.
struct TruthFreeTest {
  std::string name;  // simulation, spatial_halves, random_halves, closure, directions
  int degrees_of_freedom = 5;
  int num_units = 0;                         // pairs or loops that have a value
  int num_values = 0;                        // without those of the twins
  SharedMemberRate coverage, twin_coverage;  // of the 95 % region
  ComparedMedians ratio;                     // the pairs' median over that of chi-square
  ComparedMedians in_simulation;             // the twins' median over that of chi-square
  ComparedMedians against_twins;             // the pairs' median over the twins'
  TruthFreeVerdict verdict = TruthFreeVerdict::kNoData;
  FaultCause cause = FaultCause::kNone;
  double units_needed = 0.0;  // if undecided: units in all that would decide, roughly; NaN: not known
};

// The verdict on covariances from the interval of a ratio of variances.
TruthFreeVerdict VerdictOn(const ComparedMedians& ratio);

// Coverage of the 95 % region if the variance is too small by the factor kNominalVariance: 0.81 for five
// degrees of freedom. Lower coverage counts as a fault.
double LeastNominalCoverage(int degrees_of_freedom);

// Intervals are 95 %: of medians by a bootstrap over units, of coverage with allowance for shared members.
// Covariances are too small if the interval of `ratio` lies above one and is not nominal, or the interval of
// the coverage lies below LeastNominalCoverage; in addition a cause must be found:
//   the data       the interval of `against_twins` lies above one, or the coverage's below the twins'
//   the estimator  the interval of `in_simulation` lies above kApproximation, or that of the twins' coverage
//                  below LeastNominalCoverage
// Covariances are too large by the mirrored conditions on the medians. They hold if the interval of `ratio`
// is nominal and the coverage at least LeastNominalCoverage. Everything else is undecided.
TruthFreeTest TestCovariances(std::string name, int degrees_of_freedom, std::span<const TestUnit> units,
                              RandomStream& rng);

// Sets verdict, cause and units_needed from the other fields.
void JudgeCovariances(TruthFreeTest* test);

// The verdict from all tests of a set. Too small if any test is; else too large if spatial_halves or
// simulation is (random halves with correlated errors always are, see advice.cc); holds if every test with
// data does.
struct CovarianceVerdict {
  TruthFreeVerdict verdict = TruthFreeVerdict::kNoData;
  FaultCause cause = FaultCause::kNone;
  std::vector<std::string> tests;  // names of the tests with this verdict
};
CovarianceVerdict JudgeTests(const std::vector<TruthFreeTest>& tests);

}  // namespace rcme
