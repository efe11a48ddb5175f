#include "experiments/audit/claims/sample_statistics.h"

#include <Eigen/Eigenvalues>
#include <numeric>

#include "estimator/solvers/solver_table.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// The sign of f is arbitrary.
Vector9d ErrorOfF(const Vector9d& f, const RelativePose& pose_true) {
  const Vector9d f_true = Vectorize(EssentialFromPose(pose_true)).normalized();
  return f_true.dot(f) < 0.0 ? Vector9d(-f_true - f) : Vector9d(f_true - f);
}

// The models of the first matches with their covariances.
template <typename Solver>
ModelList<Hypothesis<Solver>, Solver::kMaxModels> FitSample(const MotionProblem& problem) {
  Sample sample(Solver::kSampleSize);
  std::iota(sample.begin(), sample.end(), 0);
  auto models = InstantiateModels<Solver>(problem, sample);
  for (int k = 0; k < models.count; ++k) PropagateCovariance(problem, &models.models[static_cast<size_t>(k)]);
  return models;
}

double DistanceFromSampleMotion(const Case& made, PointDistance distance, size_t match) {
  const MotionProblem& problem = made.problem();
  const std::optional<Hypothesis<EightPoint>> hypothesis = FitEightPoints(problem);
  if (!hypothesis) return kInfinity;
  const std::optional<UncertainFundamental> model =
      UncertainFundamental::From(hypothesis->pose, hypothesis->pose_cov, problem.camera1, problem.camera2);
  return model ? distance(*model, problem.sigma_px, problem.matches[match]) : kInfinity;
}

}  // namespace

std::optional<Hypothesis<EightPoint>> FitEightPoints(const MotionProblem& problem) {
  const auto models = FitSample<EightPoint>(problem);
  if (models.count == 0) return std::nullopt;
  return models.models[0];
}

double NeesOfF(const Vector9d& f, const Matrix9d& f_cov, const RelativePose& pose_true,
               int degrees_of_freedom) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen{Eigen::MatrixXd(f_cov)};
  if (eigen.info() != Eigen::Success || !(eigen.eigenvalues()(9 - degrees_of_freedom) > 0.0))
    return kInfinity;
  const Vector9d error = ErrorOfF(f, pose_true);
  double sum = 0.0;
  for (int k = 9 - degrees_of_freedom; k < 9; ++k) {
    const double along = eigen.eigenvectors().col(k).dot(error);
    sum += along * along / eigen.eigenvalues()(k);
  }
  return sum;
}

double NeesOfNearestF(MinimalSolver solver, const MotionProblem& problem, const RelativePose& pose_true) {
  return VisitSolver(solver, [&]<typename Solver>(std::type_identity<Solver>) {
    double nearest = kInfinity, nees = kInfinity;
    for (const Hypothesis<Solver>& hypothesis : FitSample<Solver>(problem)) {
      const double squared_error = ErrorOfF(hypothesis.model.f, pose_true).squaredNorm();
      if (squared_error >= nearest) continue;
      nearest = squared_error;
      nees = NeesOfF(hypothesis.model.f, hypothesis.f_cov, pose_true, Solver::kSampleSize);
    }
    return nees;
  });
}

double AsPrintedDistance(const UncertainFundamental& model, double sigma_px, const Correspondence& match) {
  PointResidual residual;
  return AsPrintedTest(model, sigma_px).Distance(match, &residual);
}

double RankAwareDistance(const UncertainFundamental& model, double sigma_px, const Correspondence& match) {
  PointResidual residual;
  return RankAwareTest(model, sigma_px).Distance(match, &residual);
}

Statistic TruePoseStatistic(PointDistance distance) {
  return [distance](Case& made) -> Outcome {
    const MotionProblem& problem = made.problem();
    const std::optional<UncertainFundamental> model =
        UncertainFundamental::From(made.pose_true(), Matrix5d::Zero(), problem.camera1, problem.camera2);
    return {distance(model.value(), problem.sigma_px, problem.matches.front())};
  };
}

Statistic FreshPointStatistic(PointDistance distance) {
  return [distance](Case& made) -> Outcome { return {DistanceFromSampleMotion(made, distance, 8)}; };
}

Statistic OwnPointStatistic(PointDistance distance) {
  return [distance](Case& made) -> Outcome { return {DistanceFromSampleMotion(made, distance, 0)}; };
}

}  // namespace rcme
