#include "estimator/estimators/robust_score.h"

#include "estimator/estimators/inlier_count.h"
#include "estimator/estimators/pipeline_estimator.h"
#include "estimator/estimators/ransac_model.h"
#include "estimator/robust_scores.h"

namespace rcme {
namespace {

template <typename Score>
struct RobustScorePipeline : InlierCountPipeline {
  using RobustScore = Score;
  static bool IsBetter(const InlierScore& a, const InlierScore& b, const RansacOptions&) {
    return a.negative_log_likelihood < b.negative_log_likelihood;
  }
};

class RobustScoreModel : public PlainRansacModel {
 public:
  using Factory = std::unique_ptr<RansacEstimator> (*)(const RansacOptions&);
  explicit RobustScoreModel(Factory make) : make_(make) {}
  std::vector<Parameter> Parameters() override { return ParametersWithout({"implementation"}); }
  std::unique_ptr<MotionEstimator> Make() const override { return make_(options_); }

 private:
  Factory make_;
};

}  // namespace

std::unique_ptr<RansacEstimator> MakeMsac(const RansacOptions& options) {
  return MakePipelineEstimator<RobustScorePipeline<MsacScore>>(options);
}

std::unique_ptr<RansacEstimator> MakeMlesac(const RansacOptions& options) {
  return MakePipelineEstimator<RobustScorePipeline<MlesacScore>>(options);
}

std::unique_ptr<EstimatorModel> MsacModel() { return std::make_unique<RobustScoreModel>(MakeMsac); }
std::unique_ptr<EstimatorModel> MlesacModel() { return std::make_unique<RobustScoreModel>(MakeMlesac); }

}  // namespace rcme
