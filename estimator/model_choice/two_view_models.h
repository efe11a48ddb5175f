// The three relations that two images may obey, each fitted robustly to the same matches.
//
// A rotation is a homography and a case of an epipolar geometry, and a plane's homography agrees with the
// epipolar geometry of its motion: what a smaller model explains a larger one does too, to first order. The
// searches keep to that: the homography's begins at the rotation, and where the search for a motion finds
// none, the rotation with a direction along an axis is one.
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
  RelativePose motion;  // of the essential matrix, up to the choice among its four by cheirality
  const ModelFit& operator[](TwoViewModel model) const;
};

// Fits to matches that RefuseUnsolvable lets pass (problem_check.h) for six matches or more. A pure function
// of the problem and the stream's name.
TwoViewFits FitTwoViewModels(const MotionProblem& problem, RandomStream& rng);

// The matches that agree with a model at a significance level, ascending.
std::vector<int> FindInliers(const ModelFit& fit, TwoViewModel model, double significance_level);

}  // namespace rcme
