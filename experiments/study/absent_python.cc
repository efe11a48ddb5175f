#include "experiments/study/absent_python.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <memory>

#include "estimator/estimator_registry.h"

namespace rcme {
namespace {

class AbsentFunction : public MotionEstimator {
 public:
  MotionEstimate Estimate(const MotionProblem&, RandomStream&) const override {
    return MakeRefusal(MotionStatus::kNoAnswer,
                       "a function of Python, which this program cannot call (rcme.replay in Python can)");
  }
};

// With the options of a function's entry (python/function_estimator.cc).
class AbsentFunctionModel : public EstimatorModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Text("function", &function_, "the name of a function", "a function of Python"),
            Parameter::Text("code", &code_, "a hash", "of the function's source")};
  }
  std::unique_ptr<MotionEstimator> Make() const override { return std::make_unique<AbsentFunction>(); }

 private:
  std::string function_ = "none", code_ = "none";
};

}  // namespace

void AddAbsentPython(const std::string& study_yaml) {
  const YAML::Node estimators = YAML::Load(study_yaml)["estimators"];
  const bool is_named = std::any_of(estimators.begin(), estimators.end(), [](const YAML::Node& estimator) {
    return estimator["name"] && estimator["name"].as<std::string>() == kPythonEstimator;
  });
  const bool is_known = std::ranges::count(EstimatorRegistry(), kPythonEstimator, &EstimatorEntry::name) > 0;
  if (!is_named || is_known) return;
  AddEstimator({kPythonEstimator, "a function of Python (rcme.run)",
                [] { return std::make_unique<AbsentFunctionModel>(); }, /*is_peer=*/false,
                /*is_audited=*/false});
}

}  // namespace rcme
