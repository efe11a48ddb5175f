// What kind of problem a trial is, from its exact scene: the truth that verdicts of model choice are scored
// by.
//
// Both questions are asked of the true matches without their noise, in units of the noise that the estimators
// assume.
//
//   parallax  Of each match the residual delta^2 that the best rotation leaves (homography.h's d2), and
//             with it the probability that the match with its noise shows parallax: noncentral chi-square
//             with 2 degrees of freedom and noncentrality delta^2, beyond the verdict's quantile. Their mean
//             is the share that the verdict's rule would find on average among right matches.
//   plane     The greatest share of points that one homography carries to within sqrt(2) sigma, one
//             standard deviation of the difference of two noisy points (severity/homography_share.h).
//
// A baseline of zero is a rotation. One that is not zero, however short, is none: what differs from a
// rotation by less than any test can see is too_little_parallax, and a criterion that calls it a rotation is
// counted so. To either side of each bound is a band in which the truth is a matter of words; trials in it
// are `borderline`, and are counted for themselves.
#pragma once

#include <array>
#include <span>
#include <string>

#include "estimator/model_choice/verdict.h"
#include "simulator/scene.h"
#include "stats/random.h"

namespace rcme {

enum class TrueKind { kGeneral, kPlanar, kRotationOnly, kTooLittleParallax, kBorderline };
inline constexpr std::array<TrueKind, 5> kTrueKinds = {TrueKind::kGeneral, TrueKind::kPlanar,
                                                       TrueKind::kRotationOnly, TrueKind::kTooLittleParallax,
                                                       TrueKind::kBorderline};
// The verdicts' names, and "borderline".
const std::string& Name(TrueKind kind);

struct KindMeasures {
  int num_points = 0;  // of right matches
  double baseline_m = 0.0;
  double parallax_share = 0.0;  // expected
  double plane_share = 0.0;
};

// `points_in_cam1`: those of the right matches. `rng` draws candidate planes.
KindMeasures MeasureKind(const Scene& scene, std::span<const Eigen::Vector3d> points_in_cam1, double sigma_px,
                         double parallax_significance_level, RandomStream& rng);

// Too little parallax is half the least share of the verdict's rule or less, enough is twice that or more. A
// plane holds at least 95 % of the points, a general scene has at most 75 % on any one. Fewer than eight
// right matches are borderline.
inline constexpr double kPlaneOfAll = 0.95, kPlaneOfGeneral = 0.75;
inline constexpr int kLeastRightMatches = 8;
TrueKind ClassifyKind(const KindMeasures& measures, double least_parallax_share);

}  // namespace rcme
