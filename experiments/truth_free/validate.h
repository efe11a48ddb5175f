// Whether an estimator's covariances hold on pairs whose true motions nobody knows.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/truth_free/calibration_test.h"
#include "experiments/truth_free/pair_set.h"
#include "experiments/truth_free/size_test.h"
#include "experiments/truth_free/truth_free_verdict.h"
#include "stats/median_ratio.h"

namespace rcme {

// A variance that is wrong by less than this factor is nominal: 22 % of a standard deviation.
inline constexpr double kNominalVariance = 1.5;
// A correlation of residuals below it is nominal.
inline constexpr double kNominalCorrelation = 0.05;

// The verdict that an interval of a ratio of variances allows.
TruthFreeVerdict VerdictOn(const ComparedMedians& ratio);

// A test of the covariances: normalised squared differences against those of the twins.
struct TruthFreeTest {
  std::string name;  // spatial_halves, random_halves, closure, directions
  int degrees_of_freedom = 5;
  int num_values = 0;                          // of the pairs themselves
  double coverage = 0.0, twin_coverage = 0.0;  // share within the 95 % region; NaN: none
  // By what the covariances are too small, in variance: the pairs' median over that of the twins, or, where
  // the covariances are wider than even the twins need (a factor does that), over the median of chi-square.
  ComparedMedians ratio;
  TruthFreeVerdict verdict = TruthFreeVerdict::kNoData;
};

// How alike residuals are at a distance, beyond what they are in the twins.
struct DistanceCorrelation {
  double from_px = 0.0, to_px = 0.0;
  double num_products = 0.0;
  double correlation = 0.0, twin_correlation = 0.0;
  Interval difference;  // NaN: too few
};

struct SetReport {
  std::string name;
  int num_pairs = 0, num_answered = 0;
  std::map<size_t, int> num_loops;  // whose pairs are all answered, by the number of images
  std::vector<TruthFreeTest> tests;
  double assumed_sigma_px = 0.0;
  ComparedMedians sigma_px;  // estimated from residuals, median over pairs
  std::vector<DistanceCorrelation> correlations;
  CalibrationReport calibration;
  SizeReport sizes;
  std::vector<std::string> advice;  // what to change, in words
};

struct ValidationOptions {
  std::uint64_t seed = 1;
  int num_twins = 3;  // of each pair
};

// Pure in the options' seed and the pairs' names. The random numbers of a pair are named by it.
SetReport Validate(const PairSet& set, const MotionEstimator& estimator, const ValidationOptions& options);

}  // namespace rcme
