// Tests whether the matches need a translation, or a pure rotation explains them.
//
// Without translation every direction explains the matches: the epipolar lines of [t]x R pass through the
// rotated points whatever t. The information matrix at the estimate does not show this. Noise acts as a
// parallax of sqrt(2) sigma, the direction is fitted to it, and the stated standard deviation is about a
// degree for a direction that does not exist. Two tests therefore compare the parallax with the noise:
// TestRotationAlone asks whether there is parallax at all, NoiseShareOfDirection whether it is large enough
// for the stated covariance.
//
// Null hypothesis of TestRotationAlone: the true matches follow a rotation, the others are random. The best
// rotation is fitted to the matches that agree with the motion; d2 = e' C^-1 e is the squared two-dimensional
// transfer residual of a match (refinement/rotation_equations.h). The null hypothesis is rejected at level
// alpha. Each of three tests gets a third of alpha:
//
//   tail    a true match lies beyond c = -2 log(alpha / 3n), which chi2_2 exceeds with probability
//           alpha / 3n; a rotation explains the matches within c;
//   energy  sum d2 over the k matches within c exceeds the 1 - alpha/3 quantile of chi2_{2k-3}: a small
//           parallax in all matches. (The bound c and the selection of matches near their epipolar lines
//           make the sum smaller, so the test is conservative.)
//   number  of the m matches beyond c, more agree with the motion than chance explains (motion_chance.h,
//           NFA at most alpha/3): a large parallax in some matches. Wrong matches that happen to lie near
//           their epipolar lines do not count as parallax.
//
// A rotation that is not rejected may still explain nothing: with few true matches all three tests are weak.
// The direction counts as not observable only if the NFA of the rotation is at most alpha/3 and at most that
// of the motion: of two models, prefer the one that chance explains less (Moisan & Stival).
#pragma once

#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"
#include "estimator/refinement/rotation_mle.h"

namespace rcme {

struct RotationTest {
  bool explains_matches = false;  // the rotation is not rejected, and its NFA is small enough
  RotationFit rotation;
  int num_agreeing = 0;     // matches within AgreementThreshold of the motion
  int num_beyond = 0;       // of these, beyond c of the best rotation
  int num_unexplained = 0;  // of all matches, beyond c
};

// The bounds of the test: the chi2_1 quantile (99.9 %) for agreement with the motion, and c.
double AgreementThreshold();
double TailThreshold(int num_matches, double significance_level);

// Decides from test->rotation, the fit to the matches that agree with a motion, and fills the other fields;
// set num_agreeing before. `chance`: the probability that a random match agrees with the motion.
void DecideRotationTest(const MotionProblem& problem, double chance, double significance_level,
                        RotationTest* test);

// Whether DecideRotationTest could find that a rotation explains the matches, given that no rotation has more
// than `most_within` of them within c. False nearly always, which saves the fit.
bool MayRotationExplain(const MotionProblem& problem, double chance, double significance_level,
                        int num_agreeing, int most_within);

template <typename Matches>
bool MayRotationExplain(const Matches& matches, const RelativePose& pose, double significance_level) {
  const MotionProblem& problem = matches.problem();
  const double threshold = TailThreshold(static_cast<int>(problem.matches.size()), significance_level);
  return MayRotationExplain(
      problem, matches.ChanceOfAgreement(pose, AgreementThreshold()), significance_level,
      matches.Count(matches.FindConsistent(pose, AgreementThreshold())), matches.BoundRotated(threshold));
}

// `pose` is the refined motion. `significance_level`: the greatest probability with which matches that follow
// a rotation are taken for a motion with a direction. `Matches`: see refine_winner.h.
template <typename Matches>
RotationTest TestRotationAlone(const Matches& matches, const RelativePose& pose, double significance_level) {
  const typename Matches::Set agreeing = matches.FindConsistent(pose, AgreementThreshold());
  const double threshold =
      TailThreshold(static_cast<int>(matches.problem().matches.size()), significance_level);
  RotationTest test;
  test.rotation = FitRotation(matches, agreeing, pose.R, threshold);
  test.num_agreeing = matches.Count(agreeing);
  DecideRotationTest(matches.problem(), matches.ChanceOfAgreement(pose, AgreementThreshold()),
                     significance_level, &test);
  return test;
}

// The same after a refinement from `start` over the matches `support` has diverged, as it may with too little
// parallax. The test uses the direction of `start`, since a rotation fits any direction.
template <typename Matches>
RotationTest TestRotationAloneFrom(const Matches& matches, const RelativePose& start,
                                   const typename Matches::Set& support, double significance_level) {
  const double threshold =
      TailThreshold(static_cast<int>(matches.problem().matches.size()), significance_level);
  const RotationFit fit = FitRotation(matches, support, start.R, threshold);
  return TestRotationAlone(matches, {fit.R, start.t}, significance_level);
}

// The largest share of noise in the direction's information, over all directions.
//
// With y = R x1 the constraint is g = t'm, m = y x x2; its derivative along the tangent b is B'm. m is the
// sum of the parallax and noise of covariance C = [y]x S2 [y]x' + [x2]x R S1 R' [x2]x' (S1, S2 the
// covariances of the rays). The information sum (B'm)(B'm)' / var g, var g = t'C t, therefore contains on
// average N = sum B'C B / t'C t that says nothing about the direction. With `direction_cov` the 2x2 block of
// pose_cov, the result is the largest eigenvalue of direction_cov N. Like the fit set, the sum omits matches
// near an epipole whose own share exceeds MaxLeverage. At share q the stated standard deviation is too small
// by the factor sqrt(1 - q).
double NoiseShareOfDirection(const Eigen::Matrix2d& direction_cov, const Eigen::Matrix2d& noise);

// N, one match at a time. The fast implementation is kernels/direction_noise.h.
Eigen::Matrix2d SumDirectionNoise(const MotionProblem& problem, const std::vector<int>& fitted,
                                  const RelativePose& pose, const Eigen::Matrix2d& direction_cov);

// A larger share is refused: the stated standard deviations would be more than 13 % too small.
inline constexpr double kMostNoiseInDirection = 0.25;

}  // namespace rcme
