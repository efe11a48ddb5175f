// The design of the audit: what still counts as nominal and how many trials a check may take, fixed before
// any run. Every claim takes its margins and limits from this table; `rcme audit --plan` prints what follows
// from it for each of them: the allowed range, the probability of "holds" at the nominal value, and the
// smallest departure that is found with probability 0.9 (power.h). The confidence of a target's interval is
// 1 - kAuditErrorRate / (number of claimed targets); the seed is 1 unless another is asked for.
#pragma once

#include "experiments/audit/claims/claim.h"

namespace rcme {

// A covariance counts as right if it is so up to this relative error of its standard deviations: its
// statistics may be off by what such an error would do. The mean of the probability integral transform sees
// the scale best and has the tighter margin; the coverage at each level guards the shape and the tails, where
// counts are dear.
struct ScaleTolerance {
  double coverage, mean_pit;
};
// Of a formula, where 100,000 samples are cheap.
inline constexpr ScaleTolerance kFormulaTolerance{0.04, 0.03};
// Of an estimator's answers: what 32,000 calls can decide. Wrong matches that pass for right ones make the
// covariances of sound estimators 3 to 4 % too small in sigma, on which no number of trials could agree with
// the tolerance of formulas. Such a range has room for rare gross errors, which have a bound of their own:
// kGrossErrors.
inline constexpr ScaleTolerance kEstimatorTolerance{0.08, 0.06};

struct CheckDesign {
  double margin;       // of rates and means: nominal +- margin
  TrialLimits limits;  // least, quick, full
  double share = 1.0;  // of the trials that are expected to say something of the target, for planning alone
  double spread = std::numeric_limits<double>::quiet_NaN();  // expected standard deviation, for means alone
};

// What one trial is, and what the margin is of.
inline constexpr CheckDesign kSampleCoverage{0, {4'000, 100'000, 400'000}};  // a sample; margins by tolerance
inline constexpr CheckDesign kReprojectionCoverage{0,
                                                   {4'000, 32'000, 120'000}};  // bundle adjustment, likewise
inline constexpr CheckDesign kEstimatorCoverage{0,
                                                {4'000, 32'000, 120'000}};  // an estimator's call, likewise
// Share of the motions within the failure bounds whose error lies beyond the region that one in 10,000 may
// miss.
inline constexpr double kGrossErrorLevel = 1e-4;
inline constexpr CheckDesign kGrossErrors{0.005, kEstimatorCoverage.limits};
inline constexpr CheckDesign kFailures{0, {2'000, 32'000, 120'000}};  // an estimator's call; margins below
// Failures of answers that are sure, less those that they state; more than that is too many.
inline constexpr CheckDesign kUnstatedFailures{0.002, kFailures.limits, 1, 0.02};
inline constexpr CheckDesign kStatedProbability{0.015, kFailures.limits, 1,
                                                0.2};  // mean of stated less actual failure
inline constexpr CheckDesign kWeightedProbability{0.01, kFailures.limits, 1, 0.1};  // weighted by it
inline constexpr CheckDesign kSureAnswers{0.01, kFailures.limits,
                                          0.5};  // failures among answers with P <= 0.1
// Mean of stated over true noise level, less 1. The stated standard deviation may be wrong by
// kStatedSigmaSdTolerance.
inline constexpr CheckDesign kStatedSigma{0.05, {1'000, 12'000, 60'000}, 1, 0.1};
inline constexpr double kStatedSigmaSdTolerance = 0.2;
inline constexpr CheckDesign kUntunedCoverage{0,
                                              {1'000'000, 1'000'000, 1'000'000}};  // always a million points
inline constexpr CheckDesign kIdentity{0.001,
                                       {4'000, 100'000, 400'000}};  // an identity holds in 999 of 1,000
inline constexpr CheckDesign kPerPointLevel{0.01, {4'000, 100'000, 400'000}};  // share of points that pass
inline constexpr CheckDesign kPowerOfTest{0.1, {4'000, 60'000, 400'000}};  // share rejected, or put in order
inline constexpr CheckDesign kSameLaw{0.1, {4'000, 60'000, 400'000}};      // one half of pairs
inline constexpr CheckDesign kRoc{0, {0, 4'000, 40'000}};                  // measured alone
inline constexpr CheckDesign kResidualShare{0.1, {500, 2'000, 20'000}, 1, 0.2};  // of a variance
inline constexpr CheckDesign kSelection{0.01, {2'000, 2'000, 10'000}};  // trials only one of two fails in
inline constexpr CheckDesign kQualityTestLevel{0.03, {1'000, 12'000, 40'000}, 0.75};
inline constexpr CheckDesign kStandardError{
    0.02, {1'000, 12'000, 60'000}, 0.75};                              // share of pairs within 1.96
inline constexpr CheckDesign kFlagDesign{0.1, {3'000, 3'000, 20'000}, 0.1};  // of the failures, of the others
inline constexpr CheckDesign kFailureOrder{0.5, {1'500, 3'000, 10'000}, 0.02};  // of trials with one failure
inline constexpr CheckDesign kAgainstStandard{
    0.05, {1'000, 4'000, 20'000}, 1, 0.4};  // difference of failure rates
inline constexpr CheckDesign kEarlyStopCost{0.01,
                                            {2'000, 2'000, 10'000}};  // trials that only early stop fails
inline constexpr CheckDesign kEarlyStopSaving{0.9, {2'000, 2'000, 10'000}, 1, 0.2};
inline constexpr CheckDesign kLoopExponent{0.15, {20, 20, 100}, 1, 0.05};
inline constexpr CheckDesign kRefinementExponent{0.3, {20, 20, 100}, 1, 0.15};
inline constexpr CheckDesign kPeerInliers{0.02, {500, 2'000, 20'000}, 1, 0.05};  // a mean over inliers
inline constexpr CheckDesign kAnswersToNothing{0.05, {300, 500, 5'000}};         // share of random problems

// Targets with the design's margin and expectations.
Target PlannedRate(const std::string& quantity, double nominal, const CheckDesign& design,
                   size_t statistic = 0);
Target PlannedMean(const std::string& quantity, double nominal, const CheckDesign& design,
                   size_t statistic = 0);
// Of a statistic in `range`.
Target PlannedBoundedMean(const std::string& quantity, double nominal, const Interval& allowed,
                          const Interval& range, const CheckDesign& design, size_t statistic = 0);

// nominal +- margin within [0, 1].
Interval AllowedRate(double nominal, double margin);

// The range of a coverage at 1 - alpha and of the mean of the probability integral transform of a statistic
// that is chi-square distributed up to a relative error of sigma of at most `tolerance`: for a covariance c
// times the true one
//   coverage = F(c q), q the quantile, F the law's distribution function,
//   mean PIT = E F(x / c) = P(x' <= x / c) = F_{k,k}(1 / c), x and x' independent, k degrees of freedom.
Interval CoverageWithin(int degrees_of_freedom, double significance_level, double tolerance);
Interval MeanPitWithin(int degrees_of_freedom, double tolerance);

}  // namespace rcme
