#include "estimator/hypothesis.h"

namespace rcme {

std::optional<Hypothesis> InstantiateModel(const MotionProblem& problem, const Sample& sample) {
  EightPoint::Rays rays1, rays2;
  for (size_t k = 0; k < sample.size(); ++k) {
    const Correspondence& match = problem.matches[static_cast<size_t>(sample[k])];
    rays1[k] = problem.camera1.Ray(match.x1_px);
    rays2[k] = problem.camera2.Ray(match.x2_px);
  }
  const std::optional<LinearModel> linear = EightPoint::Solve(rays1, rays2);
  if (!linear) return std::nullopt;

  Hypothesis hypothesis;
  hypothesis.sample = sample;
  hypothesis.linear = *linear;
  hypothesis.projection = ProjectToEssential(Matricize(linear->f));
  if (!hypothesis.projection.DeterminesDirection()) return std::nullopt;
  hypothesis.pose = PosesFromEssential(hypothesis.projection)[0];
  hypothesis.F =
      FundamentalFromEssential(EssentialFromPose(hypothesis.pose), problem.camera1, problem.camera2);
  return hypothesis;
}

void PropagateCovariance(const MotionProblem& problem, Hypothesis* hypothesis) {
  std::array<Correspondence, EightPoint::kSampleSize> sample;
  for (size_t k = 0; k < sample.size(); ++k) {
    sample[k] = problem.matches[static_cast<size_t>(hypothesis->sample[k])];
  }
  const Eigen::Matrix3d F_of_f =
      FundamentalFromEssential(Matricize(hypothesis->linear.f), problem.camera1, problem.camera2);
  hypothesis->f_cov =
      CovarianceOfF(hypothesis->linear, ConstraintVariances(F_of_f, sample, problem.sigma_px));
  hypothesis->pose_cov = CovarianceOfMotion(hypothesis->pose, hypothesis->f_cov);
}

}  // namespace rcme
