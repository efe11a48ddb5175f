#include "estimator/estimators/predictive_ransac.h"

#include "estimator/estimators/loop_estimator.h"
#include "estimator/estimators/ransac_model.h"
#include "estimator/estimators/standard.h"

namespace rcme {
namespace {

struct PredictiveDecision : InlierCountDecision {
  using PointTest = RankAwareTest;
  using InlierCountDecision::InlierCountDecision;
  DecidingScore deciding_score() const { return DecidingScore::kCost; }
};

class PredictiveRansac : public PlainRansacModel {
 public:
  PredictiveRansac() {
    options_.reading = Reading::kRankAware;
    options_.selection = Selection::kPredictiveLikelihood;
  }
  std::vector<Parameter> Parameters() override { return ParametersWithout({}); }
  std::unique_ptr<MotionEstimator> Make() const override {
    return MakeLoopEstimator<PredictiveDecision>(options_);
  }
};

}  // namespace

std::unique_ptr<EstimatorModel> PredictiveRansacModel() { return std::make_unique<PredictiveRansac>(); }

}  // namespace rcme
