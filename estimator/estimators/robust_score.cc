#include "estimator/estimators/robust_score.h"

#include "estimator/estimators/loop_estimator.h"
#include "estimator/estimators/ransac_model.h"
#include "estimator/estimators/standard.h"
#include "estimator/robust_scores.h"

namespace rcme {
namespace {

template <typename Score>
struct RobustScoreDecision : InlierCountDecision {
  using RobustScore = Score;
  using InlierCountDecision::InlierCountDecision;
  DecidingScore deciding_score() const { return DecidingScore::kCost; }
};

class RobustScoreModel : public PlainRansacModel {
 public:
  using Factory = std::unique_ptr<MotionEstimator> (*)(const RansacOptions&);
  explicit RobustScoreModel(Factory make) : make_(make) {}
  std::vector<Parameter> Parameters() override { return ParametersWithout({"implementation"}); }
  std::unique_ptr<MotionEstimator> Make() const override { return make_(options_); }

 private:
  Factory make_;
};

}  // namespace

std::unique_ptr<MotionEstimator> MakeMsac(const RansacOptions& options) {
  return MakeLoopEstimator<RobustScoreDecision<MsacScore>>(options);
}

std::unique_ptr<MotionEstimator> MakeMlesac(const RansacOptions& options) {
  return MakeLoopEstimator<RobustScoreDecision<MlesacScore>>(options);
}

std::unique_ptr<EstimatorModel> MsacModel() { return std::make_unique<RobustScoreModel>(MakeMsac); }
std::unique_ptr<EstimatorModel> MlesacModel() { return std::make_unique<RobustScoreModel>(MakeMlesac); }

}  // namespace rcme
