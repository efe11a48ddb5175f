#include "experiments/real/truth_free/planted_fault.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "experiments/core/text/key_value.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"

namespace rcme {
namespace {

class ScaledCovariance : public MotionEstimator {
 public:
  ScaledCovariance(std::unique_ptr<MotionEstimator> estimator, double factor)
      : estimator_(std::move(estimator)), factor_(factor) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    MotionEstimate estimate = estimator_->Estimate(problem, rng);
    for (Matrix5d* each :
         {&estimate.pose_cov, &estimate.pose_cov_without_errors, &estimate.pose_cov_with_errors})
      *each *= factor_;
    return estimate;
  }

 private:
  std::unique_ptr<MotionEstimator> estimator_;
  double factor_;
};

// Every fault as a parameter with its value and allowed range.
std::vector<Parameter> Parameters(PlantedFaults& faults) {
  std::vector<Parameter> parameters = {
      Parameter::Real("covariance", &faults.covariance, {1e-6, 1e6}, "",
                      "the estimator's covariances, times"),
      Parameter::Real("sigma", &faults.sigma, {1e-3, 1e3}, "", "the assumed noise level, times")};
  for (const CameraFault fault : kCameraFaults) {
    const auto i = static_cast<Eigen::Index>(fault);
    // A readout needs the true motion, which is not known; the last faults are never named.
    if (fault == CameraFault::kReadoutTime || i >= kNumNamedFaults) continue;
    const double greatest =
        fault == CameraFault::kFocalLength || fault == CameraFault::kDistortion ? 0.5 : 1e3;
    parameters.push_back(Parameter::Real(FindFaultText(fault).name, &faults.camera(i), {-greatest, greatest},
                                         "", FindFaultText(fault).words));
  }
  return parameters;
}

}  // namespace

std::string PlantableFaults() {
  PlantedFaults faults;
  std::string names;
  for (const Parameter& parameter : Parameters(faults))
    names += (names.empty() ? "" : ", ") + parameter.name();
  return names;
}

PlantedFaults ParsePlantedFaults(const std::vector<std::string>& settings) {
  PlantedFaults faults;
  const std::vector<Parameter> parameters = Parameters(faults);
  for (const std::string& setting : settings) {
    const KeyValue given = SplitKeyValue(setting);
    const auto found = std::ranges::find(parameters, given.key, &Parameter::name);
    if (found == parameters.end() || !given.has_equals)
      throw InputError(fmt::format("--plant: '{}' is not allowed; give NAME=VALUE, NAME one of: {}", setting,
                                   PlantableFaults()));
    found->SetFromText(given.value);
  }
  return faults;
}

PairSet PlantFaultsIn(PairSet set, const PlantedFaults& faults) {
  for (NamedPair& pair : set.pairs) {
    pair.problem = PlantFaults(std::move(pair.problem), faults.camera);
    pair.problem.sigma_px *= faults.sigma;
  }
  return set;
}

std::unique_ptr<MotionEstimator> ScaleCovariances(std::unique_ptr<MotionEstimator> estimator, double factor) {
  return std::make_unique<ScaledCovariance>(std::move(estimator), factor);
}

}  // namespace rcme
