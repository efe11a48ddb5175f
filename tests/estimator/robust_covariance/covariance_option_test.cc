// The option `covariance: robust` around an estimator whose answer is known.
#include "estimator/robust_covariance/covariance_option.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "parameters/input_error.h"
#include "tests/test_support/fit_all_matches.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// Always the same answer.
class FixedModel : public EstimatorModel {
 public:
  explicit FixedModel(const MotionEstimate& answer, const std::string& option = "")
      : answer_(answer), option_(option) {}
  std::vector<Parameter> Parameters() override {
    if (option_.empty()) return {};
    return {Parameter::Integer(option_, &value_, {0, 9}, "of a test")};
  }
  std::unique_ptr<MotionEstimator> Make() const override {
    class Fixed : public MotionEstimator {
     public:
      explicit Fixed(const MotionEstimate& answer) : answer_(answer) {}
      MotionEstimate Estimate(const MotionProblem&, RandomStream&) const override { return answer_; }

     private:
      MotionEstimate answer_;
    };
    return std::make_unique<Fixed>(answer_);
  }

 private:
  MotionEstimate answer_;
  std::string option_;
  int value_ = 3;
};

MotionEstimate EstimateWithCovariance(EstimatorModel& model, const MotionProblem& problem, bool is_robust) {
  for (Parameter& parameter : model.Parameters()) {
    if (is_robust && parameter.name() == "covariance") parameter.SetFromText("robust");
  }
  RandomStream rng({.seed = 1, .purpose = 75});
  return model.Make()->Estimate(problem, rng);
}

struct NoisyCase {
  MotionProblem problem;
  MotionEstimate answer;
};
NoisyCase MakeNoisyCase() {
  RelativePose pose_true;
  NoisyCase made;
  made.problem = TwoCameraProblem(60, 0.5, 0.0, 1, &pose_true);
  made.answer = FitAllMatches(made.problem, pose_true);
  made.answer.counts.num_hypotheses = 77;
  return made;
}

TEST(CovarianceOption, IsTheEstimatorsOwnUnlessAsked) {
  const NoisyCase c = MakeNoisyCase();
  const auto model = WithRobustCovariance(std::make_unique<FixedModel>(c.answer));
  EXPECT_EQ(EstimateWithCovariance(*model, c.problem, false).pose_cov, c.answer.pose_cov);
  const Matrix5d expected =
      *RobustCovariance(c.problem, c.answer.cam2_from_cam1, c.answer.inliers, RobustCovarianceOptions());
  const MotionEstimate robust = EstimateWithCovariance(*model, c.problem, true);
  EXPECT_EQ(robust.pose_cov, expected);
  EXPECT_NE(robust.pose_cov, c.answer.pose_cov);
  EXPECT_EQ(robust.inliers, c.answer.inliers);
}

// What the matches' noise is said to be counts only where the estimator has weighed them by it.
TEST(CovarianceOption, WeighsMatchesAsTheEstimatorDoes) {
  NoisyCase c = MakeNoisyCase();
  for (size_t i = 0; i < c.problem.matches.size(); ++i)
    c.problem.noise_scale.push_back(i % 2 == 0 ? 0.5 : 2.0);
  MotionProblem all_alike = c.problem;
  all_alike.noise_scale.clear();
  const auto expected = [&](const MotionProblem& problem) {
    return *RobustCovariance(problem, c.answer.cam2_from_cam1, c.answer.inliers, RobustCovarianceOptions());
  };
  ASSERT_NE(expected(c.problem), expected(all_alike));
  const auto weighed = WithRobustCovariance(std::make_unique<FixedModel>(c.answer), true);
  const auto not_weighed = WithRobustCovariance(std::make_unique<FixedModel>(c.answer), false);
  EXPECT_EQ(EstimateWithCovariance(*weighed, c.problem, true).pose_cov, expected(c.problem));
  EXPECT_EQ(EstimateWithCovariance(*not_weighed, c.problem, true).pose_cov, expected(all_alike));
}

TEST(CovarianceOption, RefusesOptionsOfTheRobustOneWithoutIt) {
  const NoisyCase c = MakeNoisyCase();
  for (const auto& [option, value] : Settings{{"covariance_factor", "2"},
                                              {"covariance_jackknife", "added"},
                                              {"focal_sd", "0.2"},
                                              {"principal_point_sd_px", "50"},
                                              {"distortion_sd", "0.01"}}) {
    const auto model = WithRobustCovariance(std::make_unique<FixedModel>(c.answer));
    const std::vector<Parameter> parameters = model->Parameters();
    FindParameter(parameters, option).SetFromText(value);
    try {
      model->Make();
      ADD_FAILURE() << option;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find(option + " has no effect without covariance=robust"), 0u)
          << error.what();
    }
    FindParameter(parameters, "covariance").SetFromText("robust");
    EXPECT_NO_THROW(model->Make()) << option;
  }
}

TEST(CovarianceOption, IsNotAddedASecondTime) {
  const NoisyCase c = MakeNoisyCase();
  auto with_own = std::make_unique<FixedModel>(c.answer, "covariance");
  const EstimatorModel* same = with_own.get();
  EXPECT_EQ(WithRobustCovariance(std::move(with_own)).get(), same);
  auto with_other = std::make_unique<FixedModel>(c.answer, "other");
  const EstimatorModel* wrapped = with_other.get();
  const auto model = WithRobustCovariance(std::move(with_other));
  EXPECT_NE(model.get(), wrapped);
  const std::vector<Parameter> all = model->Parameters();
  EXPECT_EQ(std::ranges::count(all, "covariance", &Parameter::name), 1);
  EXPECT_EQ(all.front().name(), "other");
}

TEST(MakeCovarianceRobust, LeavesWhatIsNoMotion) {
  const NoisyCase c = MakeNoisyCase();
  for (const std::vector<int>& inliers :
       {std::vector<int>{0, 1, 1, 2, 3, 4, 5, 6, 7}, std::vector<int>{0, 2, 1, 3, 4, 5, 6, 7, 8},
        std::vector<int>{-1, 1, 2, 3, 4, 5, 6, 7, 8}, std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 60}}) {
    MotionEstimate estimate = c.answer;
    estimate.inliers = inliers;
    MakeCovarianceRobust(c.problem, {}, std::nullopt, &estimate);
    EXPECT_EQ(estimate.status, MotionStatus::kOk);
    EXPECT_EQ(estimate.pose_cov, c.answer.pose_cov);
    EXPECT_EQ(estimate.inliers, inliers);
  }
  MotionEstimate estimate = c.answer;
  estimate.cam2_from_cam1.t.x() = std::nan("");
  MakeCovarianceRobust(c.problem, {}, std::nullopt, &estimate);
  EXPECT_EQ(estimate.pose_cov, c.answer.pose_cov);
}

TEST(MakeCovarianceRobust, RefusesInliersThatDetermineNone) {
  const NoisyCase c = MakeNoisyCase();
  MotionEstimate estimate = c.answer;
  estimate.inliers = {0, 1, 2, 3, 4};
  MakeCovarianceRobust(c.problem, {}, std::nullopt, &estimate);
  EXPECT_EQ(estimate.status, MotionStatus::kDegenerateMatches);
  EXPECT_NE(estimate.message.find("5 inliers"), std::string::npos) << estimate.message;
  EXPECT_TRUE(estimate.inliers.empty());
  EXPECT_EQ(estimate.counts.num_hypotheses, 77);
}

}  // namespace
}  // namespace rcme
