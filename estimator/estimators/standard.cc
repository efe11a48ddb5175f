#include "estimator/estimators/standard.h"

#include "estimator/estimators/loop_estimator.h"
#include "estimator/estimators/ransac_model.h"

namespace rcme {
namespace {

class Standard : public PlainRansacModel {
 public:
  std::vector<Parameter> Parameters() override { return ParametersWithout({}); }
  std::unique_ptr<MotionEstimator> Make() const override { return MakeStandard(options_); }
};

}  // namespace

std::unique_ptr<EstimatorModel> StandardModel() { return std::make_unique<Standard>(); }

std::unique_ptr<MotionEstimator> MakeStandard(const RansacOptions& options) {
  return MakeLoopEstimator<InlierCountDecision>(options);
}

}  // namespace rcme
