#include "estimator/estimators/standard.h"

#include "estimator/estimators/pipeline_estimator.h"

namespace rcme {
namespace {

struct StandardPipeline {
  using PointTest = KnownPoseTest;
  static constexpr bool kTestsSample = false;
  static bool SampleIsConsistent(const MotionProblem&, const Hypothesis&, const PointTest&,
                                 const Thresholds&) {
    return true;
  }
  static bool InlierSetIsGood(double, const RansacOptions&, const Thresholds&) { return true; }
  static bool IsBetter(const InlierScore& a, const InlierScore& b, const RansacOptions&) {
    return a.num_inliers > b.num_inliers;
  }
};

}  // namespace

std::unique_ptr<RansacEstimator> MakeStandard(const RansacOptions& options) {
  RansacOptions without_entropies = options;
  without_entropies.early_stop_entropy = RansacOptions().early_stop_entropy;
  return MakePipelineEstimator<StandardPipeline>(without_entropies);
}

}  // namespace rcme
