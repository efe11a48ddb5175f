// The true kind of a trial's problem, from its exact scene. The verdicts of model choice are scored against
// it.
//
// Two measures are taken of the noise-free true matches, in units of the noise that the estimators assume:
//
//   parallax  For each match, the residual delta^2 that the best rotation leaves (homography.h's d2) gives
//             the probability that the match with its noise shows parallax: that a noncentral chi-square
//             variable with 2 degrees of freedom and noncentrality delta^2 exceeds the verdict's quantile.
//             The mean of these probabilities is the share that the verdict's rule would find on average.
//   plane     The greatest share of points that one homography maps to within sqrt(2) sigma, one standard
//             deviation of the difference of two noisy points (severity/homography_share.h).
//
// A baseline of zero is a rotation; a nonzero one, however short, is not. A motion that differs from a
// rotation by less than any test can see is too_little_parallax, and a criterion that calls it a rotation is
// counted so. Around each bound there is a band in which the true kind is a matter of definition. Trials in
// it are `borderline` and are counted separately.
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
  int num_points = 0;  // of the right matches
  double baseline_m = 0.0;
  double parallax_share = 0.0;  // expected
  double plane_share = 0.0;
};

// `points_in_cam1`: the points of the right matches. `rng` draws candidate planes.
KindMeasures MeasureKind(const Scene& scene, std::span<const Eigen::Vector3d> points_in_cam1, double sigma_px,
                         double parallax_significance_level, RandomStream& rng);

// Too little parallax: at most half the least share of the verdict's rule; enough: at least twice that share.
// A plane holds at least 95 % of the points; a general scene has at most 75 % on any plane. Fewer than eight
// right matches are borderline.
inline constexpr double kPlaneOfAll = 0.95, kPlaneOfGeneral = 0.75;
TrueKind ClassifyKind(const KindMeasures& measures, double least_parallax_share);

}  // namespace rcme
