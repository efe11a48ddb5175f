#include "estimator/robust_covariance/covariance_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr const char* kOption = "covariance";

// Whether the estimate is a valid motion. Faults of an invalid one are reported when the answer is scored.
bool IsMotion(const MotionEstimate& estimate, size_t num_matches) {
  const std::vector<int>& inliers = estimate.inliers;
  const bool is_ascending =
      std::ranges::adjacent_find(inliers, std::ranges::greater_equal{}) == inliers.end();
  const bool are_matches =
      inliers.empty() || (inliers.front() >= 0 && inliers.back() < static_cast<int>(num_matches));
  return is_ascending && are_matches && estimate.cam2_from_cam1.R.allFinite() &&
         estimate.cam2_from_cam1.t.allFinite();
}

std::vector<Parameter> ListRobustParameters(RobustCovarianceOptions& options) {
  std::vector<Parameter> all = Parameters(options);
  all.push_back(FocalParameter(&options.calibration.focal_sd));
  all.push_back(PrincipalPointParameter(&options.calibration.principal_point_sd_px));
  all.push_back(DistortionParameter(&options.calibration.distortion_sd));
  return all;
}

class WithRobust : public MotionEstimator {
 public:
  WithRobust(std::unique_ptr<MotionEstimator> estimator, const RobustCovarianceOptions& options,
             bool uses_noise_scale)
      : estimator_(std::move(estimator)), options_(options), uses_noise_scale_(uses_noise_scale) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    MotionEstimate estimate = estimator_->Estimate(problem, rng);
    if (estimate.status != MotionStatus::kOk) return estimate;
    if (uses_noise_scale_ || problem.noise_scale.empty()) {
      MakeCovarianceRobust(problem, options_, std::nullopt, &estimate);
      return estimate;
    }
    MotionProblem all_alike = problem;  // as the estimator used them
    all_alike.noise_scale.clear();
    MakeCovarianceRobust(all_alike, options_, std::nullopt, &estimate);
    return estimate;
  }

 private:
  std::unique_ptr<MotionEstimator> estimator_;
  RobustCovarianceOptions options_;
  bool uses_noise_scale_;
};

class ModelWithRobust : public EstimatorModel {
 public:
  ModelWithRobust(std::unique_ptr<EstimatorModel> model, bool uses_noise_scale)
      : model_(std::move(model)), uses_noise_scale_(uses_noise_scale) {}

  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = model_->Parameters();
    all.push_back(Parameter::Choice<bool>(
        kOption, &is_robust_, {{"own", false}, {"robust", true}},
        "the estimator's own, or one that allows correlated errors and repeated matches"));
    for (Parameter& parameter : ListRobustParameters(options_)) all.push_back(std::move(parameter));
    return all;
  }
  void LiftLimits() override { model_->LiftLimits(); }
  std::optional<Effort> EffortOption() const override { return model_->EffortOption(); }
  std::unique_ptr<MotionEstimator> Make() const override {
    if (!is_robust_) {
      RobustCovarianceOptions given = options_, unset;
      RequireUnset(ListRobustParameters(given), ListRobustParameters(unset));
    }
    std::unique_ptr<MotionEstimator> estimator = model_->Make();
    if (!is_robust_) return estimator;
    return std::make_unique<WithRobust>(std::move(estimator), options_, uses_noise_scale_);
  }

 private:
  std::unique_ptr<EstimatorModel> model_;
  bool uses_noise_scale_;
  bool is_robust_ = false;
  RobustCovarianceOptions options_;
};

}  // namespace

void RequireUnset(const std::vector<Parameter>& given, const std::vector<Parameter>& unset) {
  for (size_t i = 0; i < given.size(); ++i) {
    if (given[i].Value() == unset[i].Value()) continue;
    throw InputError(fmt::format("{} has no effect without {}=robust; add that option or leave {} out",
                                 given[i].name(), kOption, given[i].name()));
  }
}

void MakeCovarianceRobust(const MotionProblem& problem, const RobustCovarianceOptions& options,
                          const std::optional<Matrix5d>& own_cov, MotionEstimate* estimate) {
  if (!IsMotion(*estimate, problem.matches.size())) return;
  const std::optional<Matrix5d> robust =
      RobustCovariance(problem, estimate->cam2_from_cam1, estimate->inliers, options, own_cov);
  if (robust) {
    estimate->pose_cov = *robust;
    return;
  }
  *estimate = MakeRefusal(
      MotionStatus::kDegenerateMatches,
      fmt::format("the {} inliers do not determine the covariance of a motion", estimate->inliers.size()),
      estimate->counts);
}

std::unique_ptr<EstimatorModel> WithRobustCovariance(std::unique_ptr<EstimatorModel> model,
                                                     bool uses_noise_scale) {
  const bool has_one = std::ranges::count(model->Parameters(), kOption, &Parameter::name) > 0;
  if (has_one) return model;
  return std::make_unique<ModelWithRobust>(std::move(model), uses_noise_scale);
}

}  // namespace rcme
