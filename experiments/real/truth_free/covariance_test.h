// Covariances as they are stated, held against the pairs and against simulated twins of the pairs.
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

// A variance that is wrong by less than this factor is nominal: 22 % of a standard deviation.
inline constexpr double kNominalVariance = 1.5;
// Halves and closures are chi-square to first order only: of twins, whose errors are independent and normal,
// a median that is off by less than this factor is no fault of the estimator's.
inline constexpr double kApproximation = 1.25;

// Normalised squared differences of one pair, or of one loop of pairs, and those of its twins. Units with an
// equal member are not independent (shared_members.h).
struct TestUnit {
  std::int64_t member1 = 0, member2 = 0;
  UnitValues values;
};

// What has the fault: the pairs, where simulation has none of it; the estimator, where the twins, whose
// errors are as it assumes, have it too; or both.
enum class FaultCause { kNone, kData, kEstimator, kBoth };

// The name of the test of answers to twins against their truth.
inline constexpr const char* kSimulationTest = "simulation";

// A test of the covariances. Ratios of variances are above one where covariances are too small.
struct TruthFreeTest {
  std::string name;  // simulation, spatial_halves, random_halves, closure, directions
  int degrees_of_freedom = 5;
  int num_units = 0;                         // pairs or loops that have a value
  int num_values = 0;                        // of the pairs themselves
  SharedMemberRate coverage, twin_coverage;  // of the 95 % region
  ComparedMedians ratio;                     // the pairs' median over that of chi-square
  ComparedMedians in_simulation;             // the twins' median over that of chi-square
  ComparedMedians against_twins;             // the pairs' median over the twins'
  TruthFreeVerdict verdict = TruthFreeVerdict::kNoData;
  FaultCause cause = FaultCause::kNone;
  double units_needed = 0.0;  // where it is undecided: so many in all would decide it, about; NaN: not known
};

// The verdict that an interval of a ratio of variances allows.
TruthFreeVerdict VerdictOn(const ComparedMedians& ratio);

// Coverage of the 95 % region if the variance is too small by kNominalVariance: 0.81 of five degrees of
// freedom. Less is too little.
double LeastNominalCoverage(int degrees_of_freedom);

// Medians with bootstrap intervals over units, coverage with intervals that know of shared members, 95 %.
// Stated covariances are too small if the interval of `ratio` lies above one and not within what is nominal,
// or that of the coverage below LeastNominalCoverage; and if the cause is known:
//   the data       the interval of `against_twins` lies above one, or the coverage below that of the twins
//   the estimator  that of `in_simulation` lies above kApproximation, or the twins' coverage below the least
// They are too large by the same of the medians. They hold if the interval of `ratio` is nominal and so is
// the coverage. Whatever else is undecided.
TruthFreeTest TestCovariances(std::string name, int degrees_of_freedom, std::span<const TestUnit> units,
                              RandomStream& rng);

// Sets verdict, cause and units_needed from what else a test holds.
void JudgeCovariances(TruthFreeTest* test);

// Of all tests of a set: too small if one is; too large if the halves of the image or the simulation are
// (random halves of correlated errors always are, see advice.cc); holds if every test with data does.
struct CovarianceVerdict {
  TruthFreeVerdict verdict = TruthFreeVerdict::kNoData;
  FaultCause cause = FaultCause::kNone;
  std::vector<std::string> tests;  // that say so
};
CovarianceVerdict JudgeTests(const std::vector<TruthFreeTest>& tests);

}  // namespace rcme
