#include "experiments/claims/sample_statistics.h"

#include <numeric>

#include "stats/consistency.h"

namespace rcme {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double DistanceFromSampleMotion(const Case& made, PointDistance distance, size_t match) {
  const MotionProblem& problem = made.problem();
  const std::optional<Hypothesis<EightPoint>> hypothesis = FitSample(problem);
  if (!hypothesis) return kInfinity;
  const std::optional<UncertainFundamental> model =
      UncertainFundamental::From(hypothesis->pose, hypothesis->pose_cov, problem.camera1, problem.camera2);
  return model ? distance(*model, problem.sigma_px, problem.matches[match]) : kInfinity;
}

}  // namespace

std::optional<Hypothesis<EightPoint>> FitSample(const MotionProblem& problem) {
  Sample sample(EightPoint::kSampleSize);
  std::iota(sample.begin(), sample.end(), 0);
  std::optional<Hypothesis<EightPoint>> hypothesis = InstantiateModel<EightPoint>(problem, {sample});
  if (!hypothesis) return std::nullopt;
  PropagateCovariance(problem, &*hypothesis);
  return hypothesis;
}

double NeesOfF(const Hypothesis<EightPoint>& hypothesis, const RelativePose& pose_true) {
  const Eigen::Matrix<double, 9, 8>& A = hypothesis.model.A;
  Vector9d f_true = Vectorize(EssentialFromPose(pose_true)).normalized();
  if (f_true.dot(hypothesis.model.f) < 0.0) f_true = -f_true;
  const Eigen::Matrix<double, 8, 1> error = A.transpose() * f_true;  // A'f = 0
  const Eigen::Matrix<double, 8, 8> covariance = A.transpose() * hypothesis.f_cov * A;
  return NormalizedErrorSquared(error, covariance);
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
