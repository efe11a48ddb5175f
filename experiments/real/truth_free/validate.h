// Tests an estimator's covariances on pairs whose true motions are not known.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/core/work/kept_steps.h"
#include "experiments/real/truth_free/calibration_test.h"
#include "experiments/real/truth_free/closure_by_length.h"
#include "experiments/real/truth_free/covariance_test.h"
#include "experiments/real/truth_free/pair_set.h"
#include "experiments/real/truth_free/size_test.h"
#include "experiments/real/truth_free/truth_free_verdict.h"
#include "experiments/real/truth_free/twin.h"
#include "stats/constants.h"
#include "stats/median_ratio.h"

namespace rcme {

// A smaller correlation of residuals is nominal.
inline constexpr double kNominalCorrelation = 0.05;

// Correlation of residuals at a distance, and its difference from that in the twins.
struct DistanceCorrelation {
  double from_px = 0.0, to_px = 0.0;
  double num_products = 0.0;
  double correlation = 0.0, twin_correlation = 0.0;
  Interval difference;  // NaN: too few
};

struct SetReport {
  std::string name;
  int num_pairs = 0, num_answered = 0;
  std::map<size_t, int> num_loops;  // loops whose pairs all have a motion, by the number of images
  std::vector<TruthFreeTest> tests;
  CovarianceVerdict covariances;  // of all tests
  // Sharpness: medians over the answered pairs of sqrt(trace) of the rotation block and of the direction
  // block of the covariance. NaN: no pair is answered.
  double rotation_sd_deg = kNaN, direction_sd_deg = kNaN;
  double assumed_sigma_px = 0.0;
  ComparedMedians sigma_px;                                    // estimated from residuals, median over pairs
  TruthFreeVerdict sigma_verdict = TruthFreeVerdict::kNoData;  // on the assumed sigma
  std::vector<DistanceCorrelation> correlations;
  CalibrationReport calibration;
  SizeReport sizes;
  std::vector<LengthClosure> closures;  // only with ValidationOptions::longest_loop
  std::vector<std::string> advice;      // what to change, in words
};

struct ValidationOptions {
  std::uint64_t seed = 1;
  int num_twins = 3;        // of each pair
  size_t longest_loop = 0;  // images, for the closure by length; 0: skip it
  TwinField field = {};     // of the twins' noise
};

// Runs all tests on a set. The results of each pair are a step. The random stream of a pair depends only on
// the seed and the pair's name.
//
// The test `simulation` compares the estimates on twins with the motion from which these were made, so it
// tests the estimator alone. The other tests are on the pairs and, for comparison, on their twins.
SetReport Validate(const PairSet& set, const MotionEstimator& estimator, const ValidationOptions& options,
                   KeptSteps* steps = nullptr);

}  // namespace rcme
