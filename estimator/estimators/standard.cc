#include "estimator/estimators/standard.h"

#include "estimator/estimators/pipeline_estimator.h"
#include "estimator/estimators/ransac_model.h"

namespace rcme {
namespace {

struct StandardPipeline {
  using PointTest = KnownPoseTest;
  static constexpr bool kTestsSample = false;
  static bool InlierSetIsGood(double, const RansacOptions&, const Thresholds&) { return true; }
  static bool IsBetter(const InlierScore& a, const InlierScore& b, const RansacOptions&) {
    return a.num_inliers > b.num_inliers;
  }
};

class Standard : public RansacModel {
 public:
  Standard() { options_.observability_significance_level = options_.chance_significance_level = 1.0; }
  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = rcme::Parameters(options_);
    for (Parameter& level : MotionTestParameters(options_, /*depend_on_reading=*/false)) {
      all.push_back(std::move(level));
    }
    return all;
  }
  std::unique_ptr<MotionEstimator> Make() const override { return MakeStandard(options_); }
};

}  // namespace

std::unique_ptr<EstimatorModel> StandardModel() { return std::make_unique<Standard>(); }

std::unique_ptr<RansacEstimator> MakeStandard(const RansacOptions& options) {
  return MakePipelineEstimator<StandardPipeline>(options);
}

}  // namespace rcme
