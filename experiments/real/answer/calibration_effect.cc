#include "experiments/real/answer/calibration_effect.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "estimator/calibrated/mode_covariance.h"
#include "estimator/refinement/sampson_equations.h"
#include "estimator/uncertainty/calibration_prior.h"
#include "parameters/parameter.h"
#include "parameters/settings.h"
#include "stats/constants.h"

namespace rcme {
namespace {

struct AssumedError {
  const char *text, *option;
  double sd;
  CalibrationPrior prior;
};
const AssumedError kAssumedErrors[] = {
    {"1 % of the focal length", "focal_sd", 0.01, {.focal_sd = 0.01}},
    {"5 px of the principal point", "principal_point_sd_px", 5.0, {.principal_point_sd_px = 5.0}},
    {"0.01 of k1", "distortion_sd", 0.01, {.distortion_sd = 0.01}}};

}  // namespace

bool CanStateCalibrationErrors(const EstimatorSpec& spec) {
  return FindSetting(spec.options, "covariance").value_or("own") != "own";
}

bool StatesCalibrationErrors(const EstimatorSpec& spec) {
  return CanStateCalibrationErrors(spec) &&
         std::ranges::any_of(kAssumedErrors, [&](const AssumedError& error) {
           const std::optional<std::string> text = FindSetting(spec.options, error.option);
           double sd = 0.0;
           return text && ParseReal(*text, &sd) && sd > 0.0;
         });
}

std::vector<CalibrationEffect> ComputeCalibrationEffects(const MotionProblem& problem,
                                                         const MotionEstimate& estimate) {
  const auto sum_at = [&](const MotionProblem& changed) {
    return LinearizeSampson(changed, estimate.inliers, estimate.cam2_from_cam1, Loss::kSquared);
  };
  const Eigen::LLT<Matrix5d> hessian(sum_at(problem).hessian);
  const Matrix5d inverse_hessian = hessian.solve(Matrix5d::Identity());
  if (hessian.info() != Eigen::Success || !inverse_hessian.allFinite()) return {};
  std::vector<CalibrationEffect> effects;
  for (const AssumedError& error : kAssumedErrors) {
    const Matrix5d linear = CalibrationCovariance(
        problem, error.prior, inverse_hessian,
        [&](const MotionProblem& changed) -> Vector5d { return sum_at(changed).gradient; });
    if (!linear.allFinite()) return {};
    const Matrix5d moves = BoundByUniformMotion(linear);
    effects.push_back({error.text, error.option, error.sd,
                       kDegPerRad * std::sqrt(moves.topLeftCorner<3, 3>().trace()),
                       kDegPerRad * std::sqrt(moves.bottomRightCorner<2, 2>().trace())});
  }
  return effects;
}

}  // namespace rcme
