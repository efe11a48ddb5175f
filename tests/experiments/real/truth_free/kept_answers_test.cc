// A validation and a twin that are stopped again and again give what one call gives.
#include "experiments/real/truth_free/kept_answers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "estimator/estimator_registry.h"
#include "experiments/real/truth_free/advice.h"
#include "experiments/real/truth_free/planted_fault.h"
#include "experiments/real/truth_free/twin_output.h"
#include "experiments/real/truth_free/twin_report.h"
#include "experiments/real/truth_free/validate_output.h"
#include "experiments/study/study_file.h"
#include "parameters/stop_signal.h"
#include "stats/constants.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// Throws Stopped in place of the answer after `*num_left` of them.
class StoppedEstimator : public MotionEstimator {
 public:
  StoppedEstimator(std::unique_ptr<MotionEstimator> estimator, int* num_left)
      : estimator_(std::move(estimator)), num_left_(num_left) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    if ((*num_left_)-- == 0) throw Stopped("now");
    return estimator_->Estimate(problem, rng);
  }

 private:
  std::unique_ptr<MotionEstimator> estimator_;
  int* num_left_;
};

StudyPlan SmallPlan() {
  return MakePlan(
      ParseStudy("name: made\ndata: {scene: uniform_volume, num_matches: 80, outlier_ratio: 0.2}\n"
                 "estimators: [{name: rcme_calibrated}]\ntrials: 4\n",
                 "study.yaml"));
}

// Whose covariances are too small, so that advice is followed.
std::string ValidationText(const std::function<std::unique_ptr<MotionEstimator>()>& make, KeptSteps* steps) {
  AdvisedEstimator advised;
  advised.make = [&](const Settings&) { return ScaleCovariances(make(), 0.02); };
  return MakeValidationResult(
             {ValidateAndAdvise(PairSetsOfStudy(SmallPlan()).front(), advised, {1, 1}, steps)})
      .json;
}

std::string TwinText(const std::function<std::unique_ptr<MotionEstimator>()>& make, KeptSteps* steps) {
  const StudyPlan plan = SmallPlan();
  const std::unique_ptr<MotionEstimator> estimator = make();
  const TwinSource source = AnswerScene("made", *plan.conditions[0].source, {}, *estimator, 1, steps);
  return MakeTwinsResult({MakeTwinReport(source, *estimator, "pairs", 0.5, 1, 1, steps)}).json;
}

using AnswerAsText = std::string (*)(const std::function<std::unique_ptr<MotionEstimator>()>&, KeptSteps*);

// How often it was stopped before it came to its end, after so many answers each time.
int CountStops(AnswerAsText text_of, int num_answers, const std::string& path, std::string* text) {
  const WorkPlan plan{"test", "step", "the same\n", {}, true};
  for (int num_stops = 0; num_stops < 1000; ++num_stops) {
    Runner runner = Runner::WithCheckpoint(plan, path, 1);
    KeptSteps steps(&runner);
    int num_left = num_answers;
    const auto make = [&] {
      return std::make_unique<StoppedEstimator>(MakeEstimator("rcme_calibrated"), &num_left);
    };
    try {
      *text = text_of(make, &steps);
      return num_stops;
    } catch (const Stopped& stopped) {
      EXPECT_NE(std::string(stopped.what()).find(path + " has "), std::string::npos) << stopped.what();
    }
  }
  return -1;
}

TEST(KeptSteps, StoppedAgainAndAgainGiveWhatOneCallGives) {
  for (const AnswerAsText text_of : {ValidationText, TwinText}) {
    int num_left = 1'000'000'000;
    const auto make = [&] {
      return std::make_unique<StoppedEstimator>(MakeEstimator("rcme_calibrated"), &num_left);
    };
    const std::string whole = text_of(make, nullptr);
    const int num_answers = 1'000'000'000 - num_left;
    const TempFolder folder;
    for (const int at_once : {41, 100}) {
      std::string text;
      const int num_stops =
          CountStops(text_of, at_once, folder.Path("kept_" + std::to_string(at_once)), &text);
      EXPECT_EQ(text, whole);
      EXPECT_GE(num_stops, (num_answers - 1) / at_once) << "something was not computed";
      // A step is of at most 18 answers here, or of a noise that is tried: 12.
      EXPECT_LE(num_stops, num_answers / (at_once - 18) + 1) << "something was computed twice";
    }
  }
}

TEST(AnswerFrom, GivesBackWhatIsUsed) {
  MotionEstimate estimate;
  estimate.status = MotionStatus::kOk;
  estimate.cam2_from_cam1.t = {0.6, 0.0, -0.8};
  estimate.pose_cov = 1e-300 / 3.0 * Matrix5d::Identity();
  estimate.inliers = {0, 2};
  estimate.sigma_estimated_px = 1.0 / 3.0;
  estimate.inlier_probabilities = {1.0, 0.1, 2.0 / 3.0};
  estimate.calibration_error_probability = 1.0 / 7.0;
  estimate.pose_cov_without_errors = 1e-300 / 7.0 * Matrix5d::Identity();
  const MotionEstimate back = AnswerFrom(AnswerAsJson(estimate), 3);
  EXPECT_EQ(back.status, MotionStatus::kOk);
  EXPECT_EQ(back.cam2_from_cam1.t, estimate.cam2_from_cam1.t);
  EXPECT_EQ(back.cam2_from_cam1.R, estimate.cam2_from_cam1.R);
  EXPECT_EQ(back.pose_cov, estimate.pose_cov);
  EXPECT_EQ(back.inliers, estimate.inliers);
  EXPECT_EQ(back.sigma_estimated_px, estimate.sigma_estimated_px);
  EXPECT_TRUE(std::isnan(back.failure_probability));
  EXPECT_EQ(back.calibration_error_probability, estimate.calibration_error_probability);
  EXPECT_EQ(CovarianceWithoutErrors(back), estimate.pose_cov_without_errors);
  EXPECT_EQ(back.inlier_probabilities, estimate.inlier_probabilities);
  EXPECT_ANY_THROW(AnswerFrom(AnswerAsJson(estimate), 2)) << "an inlier that is no match";
  estimate.cam2_from_cam1.t = {0.6, 0.0, kNaN};
  EXPECT_ANY_THROW(AnswerFrom(AnswerAsJson(estimate), 3)) << "a direction that is none";
}

TEST(DescribePairs, SeesWhateverIsAsked) {
  const PairSet set = PairSetsOfStudy(SmallPlan()).front();
  const std::string text = DescribePairs(set);
  EXPECT_EQ(text, DescribePairs(set));
  const auto changed = [&](const std::function<void(NamedPair*)>& change) {
    PairSet other = set;
    change(&other.pairs[1]);
    return DescribePairs(other) != text;
  };
  EXPECT_TRUE(changed([](NamedPair* pair) { pair->name += "x"; }));
  EXPECT_TRUE(changed([](NamedPair* pair) { pair->image1 = "a"; }));
  EXPECT_TRUE(changed([](NamedPair* pair) { pair->seconds_between = 2.0; }));
  EXPECT_TRUE(changed([](NamedPair* pair) { pair->problem.sigma_px *= 2.0; }));
  EXPECT_TRUE(changed([](NamedPair* pair) { pair->problem.camera2.cx += 1.0; }));
  EXPECT_TRUE(changed([](NamedPair* pair) { pair->problem.matches[3].x2_px.y() += 1e-9; }));
  EXPECT_TRUE(changed([](NamedPair* pair) { pair->problem.noise_scale.assign(80, 1.0); }));
  EXPECT_TRUE(changed([](NamedPair* pair) { pair->problem.match_quality.assign(80, 1.0); }));
}

}  // namespace
}  // namespace rcme
