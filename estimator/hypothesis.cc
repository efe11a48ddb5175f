#include "estimator/hypothesis.h"

#include "estimator/solvers/solver_table.h"
#include "estimator/uncertainty/motion_covariance.h"

namespace rcme {

template <typename Solver>
SampleRays<Solver>::SampleRays(const MotionProblem& problem, const Sample& sample) {
  for (size_t k = 0; k < first.size(); ++k) {
    const Correspondence& match = problem.matches[static_cast<size_t>(sample[k])];
    first[k] = problem.camera1.Ray(match.x1_px);
    second[k] = problem.camera2.Ray(match.x2_px);
  }
}

// p_j of f_j (eq::motion_estimate).
template <typename Solver>
std::optional<Hypothesis<Solver>> HypothesisFromModel(const MotionProblem& problem, const HypothesisId& id,
                                                      const typename Solver::Model& model) {
  Hypothesis<Solver> hypothesis;
  hypothesis.id = id;
  hypothesis.model = model;
  hypothesis.projection = ProjectToEssential(Matricize(model.f));
  if (!hypothesis.projection.DeterminesDirection()) return std::nullopt;
  hypothesis.pose = PosesFromEssential(hypothesis.projection)[0];
  hypothesis.F =
      FundamentalFromEssential(EssentialFromPose(hypothesis.pose), problem.camera1, problem.camera2);
  return hypothesis;
}

// Every f_j of S_j (eq::model_instantiate), by the minimal solver.
template <typename Solver>
ModelList<Hypothesis<Solver>, Solver::kMaxModels> InstantiateModels(const MotionProblem& problem,
                                                                    const Sample& sample) {
  const SampleRays<Solver> rays(problem, sample);
  ModelList<Hypothesis<Solver>, Solver::kMaxModels> hypotheses;
  for (const typename Solver::Model& model : Solver::FindModels(rays.first, rays.second)) {
    const auto hypothesis = HypothesisFromModel<Solver>(problem, {sample, hypotheses.count}, model);
    if (hypothesis) hypotheses.Add(*hypothesis);
  }
  return hypotheses;
}

template <typename Solver>
std::optional<Hypothesis<Solver>> InstantiateModel(const MotionProblem& problem, const HypothesisId& id) {
  const auto hypotheses = InstantiateModels<Solver>(problem, id.sample);
  if (id.model < 0 || id.model >= hypotheses.count) return std::nullopt;
  return hypotheses.models[static_cast<size_t>(id.model)];
}

// Sigma_p = J_p Sigma_f J_p' (eq::cov_p). For at most five matches it is L L' with L = J_p G D^(1/2).
template <typename Solver>
void PropagateCovariance(const MotionProblem& problem, Hypothesis<Solver>* hypothesis) {
  constexpr int m = Solver::kSampleSize;
  const Eigen::Matrix3d F_of_f =
      FundamentalFromEssential(Matricize(hypothesis->model.f), problem.camera1, problem.camera2);
  Eigen::Matrix<double, m, 1> D;
  for (int k = 0; k < m; ++k) {
    const int index = hypothesis->id.sample[static_cast<size_t>(k)];
    D(k) = ConstraintVariance(F_of_f, problem.matches[static_cast<size_t>(index)], problem.sigma_px);
  }
  hypothesis->f_cov = CovarianceOfF(hypothesis->model.G, D);
  if constexpr (Hypothesis<Solver>::kHasFactor) {
    hypothesis->pose_factor.template leftCols<m>() =
        MotionJacobian(hypothesis->pose) * hypothesis->model.G * D.cwiseSqrt().asDiagonal();
    hypothesis->pose_cov = hypothesis->pose_factor * hypothesis->pose_factor.transpose();
  } else {
    hypothesis->pose_cov = CovarianceOfMotion(hypothesis->pose, hypothesis->f_cov);
  }
}

template <typename Solver>
std::optional<UncertainFundamental> ComputeUncertainFundamental(const MotionProblem& problem,
                                                                const Hypothesis<Solver>& hypothesis) {
  if constexpr (Hypothesis<Solver>::kHasFactor) {
    return UncertainFundamental::FromFactor(hypothesis.pose, hypothesis.pose_factor, problem.camera1,
                                            problem.camera2);
  } else {
    return UncertainFundamental::From(hypothesis.pose, hypothesis.pose_cov, problem.camera1, problem.camera2);
  }
}

#define RCME_INSTANTIATE_HYPOTHESES_OF(Solver, name)                                                         \
  template struct SampleRays<Solver>;                                                                        \
  template std::optional<Hypothesis<Solver>> HypothesisFromModel<Solver>(                                    \
      const MotionProblem&, const HypothesisId&, const Solver::Model&);                                      \
  template ModelList<Hypothesis<Solver>, Solver::kMaxModels> InstantiateModels<Solver>(const MotionProblem&, \
                                                                                       const Sample&);       \
  template std::optional<Hypothesis<Solver>> InstantiateModel<Solver>(const MotionProblem&,                  \
                                                                      const HypothesisId&);                  \
  template void PropagateCovariance<Solver>(const MotionProblem&, Hypothesis<Solver>*);                      \
  template std::optional<UncertainFundamental> ComputeUncertainFundamental<Solver>(                          \
      const MotionProblem&, const Hypothesis<Solver>&);
RCME_FOR_EACH_SOLVER(RCME_INSTANTIATE_HYPOTHESES_OF)
#undef RCME_INSTANTIATE_HYPOTHESES_OF

}  // namespace rcme
