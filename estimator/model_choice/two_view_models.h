// The three relations that two images may obey, each fitted robustly to the same matches.
//
// To first order a larger model explains what a smaller one does: a rotation is a homography and a special
// epipolar geometry, and a plane's homography agrees with the epipolar geometry of its motion. The searches
// preserve this. That for a homography starts at the rotation; that for an essential matrix also tries the
// rotation with a direction along each axis.
#pragma once

#include <array>
#include <vector>

#include "estimator/geometry/pose.h"
#include "estimator/model_choice/criteria.h"
#include "estimator/motion_problem.h"
#include "stats/random.h"

namespace rcme {

enum class TwoViewModel { kRotation, kHomography, kEssential };
inline constexpr std::array<TwoViewModel, 3> kTwoViewModels = {
    TwoViewModel::kRotation, TwoViewModel::kHomography, TwoViewModel::kEssential};
const ModelDimensions& FindDimensions(TwoViewModel model);

struct ModelFit {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();  // R, H or E, between rays
  // e^2 of each match over sigma^2: transfer residual (homography.h) or Sampson distance; infinite where the
  // model takes the point behind camera 2.
  std::vector<double> squared_residuals;
};

struct TwoViewFits {
  ModelFit rotation, homography, essential;
  RelativePose motion;  // one of the essential matrix's motions; cheirality may not be decided
  const ModelFit& operator[](TwoViewModel model) const;
};

// Fits to matches that pass RefuseUnsolvable (problem_check.h) with at least six matches. A pure function of
// the problem and the stream's name.
TwoViewFits FitTwoViewModels(const MotionProblem& problem, RandomStream& rng);

// The matches that agree with a model at a significance level, ascending.
std::vector<int> FindInliers(const ModelFit& fit, TwoViewModel model, double significance_level);

}  // namespace rcme
