// Do the matches need a translation, or does a rotation explain them?
//
// Without a translation every direction explains the matches: the epipolar lines of [t]x R pass through the
// rotated points whatever t. The information matrix at the estimate does not show it, because the noise is a
// parallax of its own, of sqrt(2) sigma, and the direction fits that: reported are standard deviations of a
// degree for a direction that does not exist. So the parallax is held against its noise, twice: is there one
// at all (TestRotationAlone), and is it large enough for the reported covariance (NoiseShareOfDirection).
//
// Null hypothesis: the right matches follow a rotation, the rest is random. The best rotation is fitted to
// the matches that agree with the motion, d2 = e' C^-1 e the squared two-dimensional transfer residual of
// each (refinement/rotation_equations.h). The null hypothesis is rejected at level alpha, a third of it for
// each of:
//
//   tail    a right match lies beyond c = -2 log(alpha / 3n), which chi2_2 exceeds with probability alpha /
//   3n;
//           c is the bound between what the rotation explains and what it does not;
//   energy  sum d2 over the k matches within c exceeds the 1 - alpha/3 quantile of chi2_{2k-3}: the parallax
//           is small and everywhere. (The bound c, and the choice of matches near their epipolar lines, make
//           the sum smaller: the level is kept.)
//   number  of the m matches beyond c, more agree with the motion than chance gives (motion_chance.h, NFA at
//           most alpha/3): the parallax is large, if only of a few. Wrong matches that happen to lie near
//           their epipolar lines do not count as parallax.
//
// A rotation that is not rejected need not explain anything: where few matches are right, all three are weak.
// The direction counts as not observable only if the rotation's own NFA is at most alpha/3, and at most that
// of the motion: of two models the one that chance explains less (Moisan & Stival's choice between models).
#pragma once

#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"
#include "estimator/refinement/rotation_mle.h"

namespace rcme {

struct RotationTest {
  bool explains_matches = false;  // not rejected, and no worse than the motion
  RotationFit rotation;
  int num_agreeing = 0;     // matches that agree with the motion at 99.9 %
  int num_beyond = 0;       // of these, beyond c of the best rotation
  int num_unexplained = 0;  // of all matches, beyond c
};

// The bounds of the test: chi2_1 of the matches that agree with the motion, and c.
double AgreementThreshold();
double TailThreshold(int num_matches, double significance_level);

// The verdict from the fit to the matches that agree with a motion: fills the other fields. `chance`: that a
// random match agrees with the motion.
void DecideRotationTest(const MotionProblem& problem, double chance, double significance_level,
                        RotationTest* test);

// Whether DecideRotationTest can say that a rotation explains the matches, if no rotation explains more than
// `most_within` of them. Tells without a fit that there is no such rotation, as nearly always.
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

// `pose` is the refined motion; alpha is the greatest probability that matches which follow a rotation are
// taken for a motion with a direction. `Matches`: see refine_winner.h.
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

// Where the refinement of a motion begun at `start` with the matches `support` has diverged, as it may where
// there is too little parallax. Any direction fits a rotation, so the start's is taken.
template <typename Matches>
RotationTest TestRotationAloneFrom(const Matches& matches, const RelativePose& start,
                                   const typename Matches::Set& support, double significance_level) {
  const double threshold =
      TailThreshold(static_cast<int>(matches.problem().matches.size()), significance_level);
  const RotationFit fit = FitRotation(matches, support, start.R, threshold);
  return TestRotationAlone(matches, {fit.R, start.t}, significance_level);
}

// The greatest share, over the directions, of the direction's information that is noise.
//
// With y = R x1 the constraint is g = t'm, m = y x x2, and its derivative along the tangent b is B'm. Of m
// the parallax is one part and the noise another, with covariance C = [y]x S2 [y]x' + [x2]x R S1 R' [x2]x'
// (S1, S2 those of the rays). So the information sum (B'm)(B'm)' / var g, var g = t'C t, holds on average N =
// sum B'C B / t'C t that is not information about the direction. With `direction_cov` the 2x2 block of
// pose_cov, returned is the greatest eigenvalue of direction_cov N. A match whose own share is beyond
// MaxLeverage, next to an epipole, is left out as in the fit set. At share q the reported standard deviation
// is too small by sqrt(1 - q).
double NoiseShareOfDirection(const Eigen::Matrix2d& direction_cov, const Eigen::Matrix2d& noise);

// N, one match at a time; the twin that the fast implementation takes is kernels/direction_noise.h.
Eigen::Matrix2d SumDirectionNoise(const MotionProblem& problem, const std::vector<int>& fitted,
                                  const RelativePose& pose, const Eigen::Matrix2d& direction_cov);

// More than this is refused: standard deviations would be more than 13 % too small.
inline constexpr double kMostNoiseInDirection = 0.25;

}  // namespace rcme
