// Whether an estimator's covariances hold on pairs whose true motions nobody knows.
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

// A correlation of residuals below it is nominal.
inline constexpr double kNominalCorrelation = 0.05;
// An assumed sigma is nominal if the estimated one lies within this of it.
inline constexpr Interval kNominalSigma = {0.8, 1.25};

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
  CovarianceVerdict covariances;  // of all tests
  // How sharp the covariances are: medians over the answered pairs of what is stated, the root of the trace
  // of the rotation's and of the direction's block. NaN: none is answered.
  double rotation_sd_deg = kNaN, direction_sd_deg = kNaN;
  double assumed_sigma_px = 0.0;
  ComparedMedians sigma_px;                                    // estimated from residuals, median over pairs
  TruthFreeVerdict sigma_verdict = TruthFreeVerdict::kNoData;  // of the assumed one
  std::vector<DistanceCorrelation> correlations;
  CalibrationReport calibration;
  SizeReport sizes;
  std::vector<LengthClosure> closures;  // where they are asked for
  std::vector<std::string> advice;      // what to change, in words
};

struct ValidationOptions {
  std::uint64_t seed = 1;
  int num_twins = 3;        // of each pair
  size_t longest_loop = 0;  // images, of the closure by length; 0: it is not asked for
  TwinField field = {};     // of the twins' noise
};

// What is computed of a pair is a step. Pure in the options' seed and the pairs' names. The random numbers of
// a pair are named by it.
//
// Tests: `simulation`, the answers to the twins against the motion that these were made of, is of the
// estimator alone; the others are of the pairs, with the same of their twins.
SetReport Validate(const PairSet& set, const MotionEstimator& estimator, const ValidationOptions& options,
                   KeptSteps* steps = nullptr);

}  // namespace rcme
