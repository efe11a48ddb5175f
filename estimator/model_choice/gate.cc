#include "estimator/model_choice/gate.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "estimator/model_choice/verdict.h"

namespace rcme {
namespace {

constexpr const char* kGateOption = "model_choice";

struct GateOptions {
  std::optional<ModelCriterion> criterion;  // nothing: off
  bool refuses_planes = true;
  ModelChoiceOptions choice;  // its criterion is the one above
};

std::vector<std::pair<std::string, std::optional<ModelCriterion>>> Criteria() {
  std::vector<std::pair<std::string, std::optional<ModelCriterion>>> all = {{"off", std::nullopt}};
  all.insert(all.end(), CriterionNames().begin(), CriterionNames().end());
  return all;
}

// The status of the refusal; kOk if there is no reason to refuse.
MotionStatus FindStatus(const ModelChoice& choice, bool refuses_planes) {
  if (choice.status != MotionStatus::kOk) return MotionStatus::kOk;
  switch (choice.verdict) {
    case SceneVerdict::kPlanar:
      return refuses_planes ? MotionStatus::kPlanarScene : MotionStatus::kOk;
    case SceneVerdict::kRotationOnly:
      return MotionStatus::kRotationOnly;
    case SceneVerdict::kTooLittleParallax:
      return MotionStatus::kTooLittleParallax;
    case SceneVerdict::kGeneral:
      break;
  }
  return MotionStatus::kOk;
}

class GatedEstimator : public MotionEstimator {
 public:
  GatedEstimator(std::unique_ptr<MotionEstimator> estimator, const GateOptions& options)
      : estimator_(std::move(estimator)), options_(options) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    MotionEstimate estimate = estimator_->Estimate(problem, rng);
    if (estimate.status != MotionStatus::kOk) return estimate;
    const ModelChoice choice = ChooseModel(problem, options_.choice, rng);
    const MotionStatus status = FindStatus(choice, options_.refuses_planes);
    if (status == MotionStatus::kOk) return estimate;
    return MakeRefusal(status, choice.message, estimate.counts);
  }

 private:
  std::unique_ptr<MotionEstimator> estimator_;
  GateOptions options_;
};

class GatedModel : public EstimatorModel {
 public:
  explicit GatedModel(std::unique_ptr<EstimatorModel> model) : model_(std::move(model)) {}

  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = model_->Parameters();
    all.push_back(Parameter::Choice<std::optional<ModelCriterion>>(
        kGateOption, &options_.criterion, Criteria(),
        "criterion that refuses pure rotations, too little parallax and planes"));
    all.push_back(Parameter::Choice<bool>("planar_scenes", &options_.refuses_planes,
                                          {{"refused", true}, {"answered", false}},
                                          "model_choice's answer for points on a plane"));
    for (Parameter& parameter : ParallaxParameters(options_.choice)) all.push_back(std::move(parameter));
    return all;
  }
  void LiftLimits() override {
    model_->LiftLimits();
    options_.criterion.reset();
  }
  std::optional<Effort> EffortOption() const override { return model_->EffortOption(); }
  std::unique_ptr<MotionEstimator> Make() const override {
    std::unique_ptr<MotionEstimator> estimator = model_->Make();
    if (!options_.criterion) return estimator;
    GateOptions options = options_;
    options.choice.criterion = *options_.criterion;
    return std::make_unique<GatedEstimator>(std::move(estimator), options);
  }

 private:
  std::unique_ptr<EstimatorModel> model_;
  GateOptions options_;
};

}  // namespace

std::unique_ptr<EstimatorModel> WithGate(std::unique_ptr<EstimatorModel> model) {
  const bool has_one = std::ranges::count(model->Parameters(), kGateOption, &Parameter::name) > 0;
  if (has_one) return model;
  return std::make_unique<GatedModel>(std::move(model));
}

}  // namespace rcme
