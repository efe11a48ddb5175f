#include "estimator/estimators/m_estimator.h"

#include <vector>

#include "estimator/estimators/ransac_model.h"
#include "estimator/estimators/robust_score.h"
#include "estimator/motion_tests.h"
#include "estimator/ransac_estimate.h"
#include "estimator/reference_matches.h"
#include "estimator/refine_winner.h"
#include "estimator/refinement/m_estimation.h"

namespace rcme {
namespace {

// MSAC without refinement, and without any test that could refuse its motion.
RansacOptions OptionsOfStart(RansacOptions options) {
  options.refinement = Refinement::kNone;
  options.least_explained_share = 0.0;
  options.observability_significance_level = options.chance_significance_level = 1.0;
  return options;
}

// The matches to which an M-estimation has fitted the motion: those within the tuning constant.
std::vector<int> FindFitted(const MotionProblem& problem, const RelativePose& pose,
                            const MEstimation& options) {
  const double c = options.TuningConstantOrDefault();
  return ReferenceMatches(problem, RefinementError::kSampson).FindConsistent(pose, c * c);
}

class MEstimator : public MotionEstimator {
 public:
  MEstimator(const RansacOptions& options, const MEstimation& estimation)
      : options_(options), estimation_(estimation), start_(MakeMsac(OptionsOfStart(options))) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    MotionEstimate estimate = start_->Estimate(problem, rng);
    if (estimate.status != MotionStatus::kOk) return estimate;
    const ReferenceMatches matches(problem, RefinementError::kSampson);
    const double threshold = ConsistencyThreshold(options_.significance_level);
    const std::vector<int> support = matches.FindConsistent(estimate.cam2_from_cam1, threshold);
    const RefinedMotion refined = Refine(matches, estimate.cam2_from_cam1);
    if (!refined.converged) {
      MotionEstimate refusal = EstimateWithoutMotion(estimate);
      ExplainDivergence(matches, options_, estimate.cam2_from_cam1, support, &refusal);
      return refusal;
    }
    estimate.cam2_from_cam1 = refined.cam2_from_cam1;
    estimate.pose_cov = refined.pose_cov;
    estimate.inliers = matches.FindAgreeing(refined, FindFitted(problem, refined.cam2_from_cam1, estimation_),
                                            options_.significance_level);
    estimate.num_consistent_before = matches.Count(support);
    estimate.num_consistent_after = matches.CountConsistent(support, refined.cam2_from_cam1, threshold);
    estimate.num_explained = matches.CountConsistent(matches.All(), refined.cam2_from_cam1, threshold);
    estimate.failed_by_kappa =
        estimate.num_consistent_after <= options_.kappa * estimate.num_consistent_before;
    const auto num_matches = static_cast<int>(problem.matches.size());
    estimate.message = SuccessMessage(static_cast<int>(estimate.inliers.size()), num_matches);
    RefuseByMotionTests(matches, options_, &estimate);
    CheckExplainedShare(options_, num_matches, &estimate);
    return estimate;
  }

 private:
  // Repeats the M-estimation if cheirality, decided again at the optimum, selects another of the four motions
  // of E. The cost is the same for all four.
  RefinedMotion Refine(const ReferenceMatches& matches, const RelativePose& start) const {
    const MotionProblem& problem = matches.problem();
    const RefinedMotion motion = RefineByMEstimation(problem, start, estimation_);
    if (!motion.converged) return motion;
    const RelativePose& pose = motion.cam2_from_cam1;
    const RelativePose chosen = matches.SelectPose(ProjectToEssential(EssentialFromPose(pose)),
                                                   FindFitted(problem, pose, estimation_));
    const bool is_same = chosen.t.dot(pose.t) > 0.0 && RotationAngleBetween(chosen.R, pose.R) < 0.5;
    return is_same ? motion : RefineByMEstimation(problem, chosen, estimation_);
  }

  static MotionEstimate EstimateWithoutMotion(const MotionEstimate& start) {
    MotionEstimate refusal = MakeRefusal(MotionStatus::kRefinementDiverged,
                                         "the M-estimation found no optimum with a covariance", start.counts);
    refusal.hypothesis = start.hypothesis;
    refusal.num_support = start.num_support;
    return refusal;
  }

  RansacOptions options_;
  MEstimation estimation_;
  std::unique_ptr<MotionEstimator> start_;
};

class Model : public PlainRansacModel {
 public:
  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = ParametersWithout({"implementation", "refinement", "refinement_error"});
    all.push_back(Parameter::Choice<RobustLoss>(
        "loss", &estimation_.loss, {{"huber", RobustLoss::kHuber}, {"tukey", RobustLoss::kTukey}},
        "function of the distances that is summed"));
    all.push_back(
        Parameter::RealOrWords("tuning_constant", &estimation_.tuning_constant, {0.1, 100.0}, {{"auto", 0.0}},
                               "sigma", "of the loss; auto: 95 % efficient, 1.345 (huber) or 4.685 (tukey)"));
    return all;
  }
  std::unique_ptr<MotionEstimator> Make() const override {
    return std::make_unique<MEstimator>(options_, estimation_);
  }

 private:
  MEstimation estimation_;
};

}  // namespace

std::unique_ptr<EstimatorModel> MEstimatorModel() { return std::make_unique<Model>(); }

}  // namespace rcme
