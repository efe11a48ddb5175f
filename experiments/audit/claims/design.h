// The design of the audit, fixed before any run: the range that counts as nominal, and the number of trials
// of a check. Every claim takes its margins and limits from this table. `rcme audit --plan` prints the
// consequences for each claim: the allowed range, the probability of "holds" at the nominal value, and the
// smallest deviation that is detected with probability 0.9 (power.h). The confidence of a target's interval
// is 1 - kAuditErrorRate / (number of claimed targets). The seed is 1 unless another is given.
#pragma once

#include "experiments/audit/claims/claim.h"

namespace rcme {

// A covariance counts as right if the relative error of its standard deviations is at most this: its
// statistics may deviate as much as such an error would cause. The mean of the probability integral transform
// is most sensitive to the scale and has the tighter margin. The coverage at each level guards the shape and
// the tails, where counts are expensive.
struct ScaleTolerance {
  double coverage, mean_pit;
};
// For a formula, where 100,000 samples are cheap.
inline constexpr ScaleTolerance kFormulaTolerance{0.04, 0.03};
// For an estimator's answers: what 32,000 calls can decide. Wrong matches that pass for right ones make the
// covariances of sound estimators 3 to 4 % too small in sigma. With the tolerance of formulas no number of
// trials could call these nominal. This range leaves room for rare gross errors, which have their own bound:
// kGrossErrors.
inline constexpr ScaleTolerance kEstimatorTolerance{0.08, 0.06};

struct CheckDesign {
  double margin;       // of rates and means: nominal +- margin
  TrialLimits limits;  // least, quick, full
  double share = 1.0;  // expected share of trials that contribute to the target, only for planning
  double spread = std::numeric_limits<double>::quiet_NaN();  // expected standard deviation, only for means
};

// Each comment names the unit of a trial, or the quantity to which the margin belongs.

// A sample; the margins follow from the tolerance.
inline constexpr CheckDesign kSampleCoverage{0, {4'000, 100'000, 400'000}};
// A bundle adjustment; the margins follow from the tolerance.
inline constexpr CheckDesign kReprojectionCoverage{0, {4'000, 32'000, 120'000}};
// A call of an estimator; the margins follow from the tolerance.
inline constexpr CheckDesign kEstimatorCoverage{0, {4'000, 32'000, 120'000}};
// Share of the motions within the failure bounds that lie beyond the region of confidence 1 - 1e-4.
inline constexpr double kGrossErrorLevel = 1e-4;
inline constexpr CheckDesign kGrossErrors{0.005, kEstimatorCoverage.limits};
// A call of an estimator; the margins are below.
inline constexpr CheckDesign kFailures{0, {2'000, 32'000, 120'000}};
// Failures of sure answers minus those that they state; only an excess counts.
inline constexpr CheckDesign kUnstatedFailures{0.002, kFailures.limits, 1, 0.02};
// Mean of the stated probability minus the actual failure.
inline constexpr CheckDesign kStatedProbability{0.015, kFailures.limits, 1, 0.2};
// The same, weighted by the stated probability.
inline constexpr CheckDesign kWeightedProbability{0.01, kFailures.limits, 1, 0.1};
// Failures among answers with P <= 0.1.
inline constexpr CheckDesign kSureAnswers{0.01, kFailures.limits, 0.5};
// Mean of stated over true noise level, minus 1. The stated standard deviation may be wrong by
// kStatedSigmaSdTolerance.
inline constexpr CheckDesign kStatedSigma{0.05, {1'000, 12'000, 60'000}, 1, 0.1};
inline constexpr double kStatedSigmaSdTolerance = 0.2;
// Always a million points.
inline constexpr CheckDesign kUntunedCoverage{0, {1'000'000, 1'000'000, 1'000'000}};
// An identity holds in 999 of 1,000 trials.
inline constexpr CheckDesign kIdentity{0.001, {4'000, 100'000, 400'000}};
// Share of points that pass.
inline constexpr CheckDesign kPerPointLevel{0.01, {4'000, 100'000, 400'000}};
// Share of models that pass or are rejected, or of pairs that are put in the right order.
inline constexpr CheckDesign kPowerOfTest{0.1, {4'000, 60'000, 400'000}};
// One half of pairs.
inline constexpr CheckDesign kSameLaw{0.1, {4'000, 60'000, 400'000}};
// Only measured.
inline constexpr CheckDesign kRoc{0, {0, 4'000, 40'000}};
// Share of a variance.
inline constexpr CheckDesign kResidualShare{0.1, {500, 2'000, 20'000}, 1, 0.2};
// Share of trials in which exactly one of two fails.
inline constexpr CheckDesign kSelection{0.01, {2'000, 2'000, 10'000}};
inline constexpr CheckDesign kQualityTestLevel{0.03, {1'000, 12'000, 40'000}, 0.75};
// Share of pairs within 1.96 standard errors.
inline constexpr CheckDesign kStandardError{0.02, {1'000, 12'000, 60'000}, 0.75};
// Share of the failures that are flagged, and of the other answers that are not.
inline constexpr CheckDesign kFlagDesign{0.1, {3'000, 3'000, 20'000}, 0.1};
// Share of the trials in which exactly one of two fails.
inline constexpr CheckDesign kFailureOrder{0.5, {1'500, 3'000, 10'000}, 0.02};
// Difference of failure rates.
inline constexpr CheckDesign kAgainstStandard{0.05, {1'000, 4'000, 20'000}, 1, 0.4};
// Share of trials that fail only with early stop.
inline constexpr CheckDesign kEarlyStopCost{0.01, {2'000, 2'000, 10'000}};
inline constexpr CheckDesign kEarlyStopSaving{0.9, {2'000, 2'000, 10'000}, 1, 0.2};
inline constexpr CheckDesign kLoopExponent{0.15, {20, 20, 100}, 1, 0.05};
inline constexpr CheckDesign kRefinementExponent{0.3, {20, 20, 100}, 1, 0.15};
// Mean over inliers.
inline constexpr CheckDesign kPeerInliers{0.02, {500, 2'000, 20'000}, 1, 0.05};
// Share of random problems that are answered.
inline constexpr CheckDesign kAnswersToNothing{0.05, {300, 500, 5'000}};

// Targets with the margin and the expectations of the design.
Target PlannedRate(const std::string& quantity, double nominal, const CheckDesign& design,
                   size_t statistic = 0);
Target PlannedMean(const std::string& quantity, double nominal, const CheckDesign& design,
                   size_t statistic = 0);
// For a statistic in `range`.
Target PlannedBoundedMean(const std::string& quantity, double nominal, const Interval& allowed,
                          const Interval& range, const CheckDesign& design, size_t statistic = 0);

// nominal +- margin within [0, 1].
Interval AllowedRate(double nominal, double margin);

// The range of a coverage at 1 - alpha, and of the mean of the probability integral transform, of a statistic
// that is chi-square distributed up to a relative error of sigma of at most `tolerance`. For a covariance c
// times the true one,
//   coverage = F(c q), q the quantile, F the distribution function,
//   mean PIT = E F(x / c) = P(x' <= x / c) = F_{k,k}(1 / c), x and x' independent, k degrees of freedom.
Interval CoverageWithin(int degrees_of_freedom, double significance_level, double tolerance);
Interval MeanPitWithin(int degrees_of_freedom, double tolerance);

}  // namespace rcme
