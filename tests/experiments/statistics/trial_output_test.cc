#include "experiments/statistics/trial_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "estimator/geometry/pose.h"
#include "experiments/core/text/field_text.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"
#include "tests/test_support/test_estimators.h"

namespace rcme {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;
using testing::Not;

// The small study with a few keys set.
StudyPlan PlanWith(const Settings& changes) {
  Study study = SmallStudy();
  for (const auto& [key, value] : changes) Override(&study, key, value);
  return MakePlan(study);
}

// One trial of the plan's last condition: 30 % wrong matches unless the plan says otherwise.
TrialResult RunLast(const StudyPlan& plan, std::uint32_t trial = 0) {
  return RunTrial(plan, plan.conditions.back(), trial);
}

// The first trial of it in which no estimator refuses.
TrialResult RunAnswered(const StudyPlan& plan) {
  for (std::uint32_t trial = 0;; ++trial) {
    TrialResult result = RunLast(plan, trial);
    if (trial == 100 || std::ranges::none_of(result.records, HasRefused)) return result;
  }
}

Json ParseTrialJson(const StudyPlan& plan, const TrialResult& result,
                    const std::vector<size_t>& drawn = {0}) {
  return Json::parse(TrialAsJson(plan, result, drawn));
}

double At(const Json& numbers, size_t i) { return numbers.at(i).get<double>(); }

Eigen::Vector3d VectorFrom(const Json& numbers) {
  return Eigen::Vector3d(At(numbers, 0), At(numbers, 1), At(numbers, 2));
}

Eigen::Matrix3d MatrixFrom(const Json& row_major) {
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = At(row_major, static_cast<size_t>(i));
  return matrix;
}

// How far the second end of a match [x1, y1, x2, y2] lies from its epipolar line F x1, px.
double DistanceFromLine(const Eigen::Matrix3d& F, const Json& match) {
  const Eigen::Vector3d line = F * Eigen::Vector3d(At(match, 0), At(match, 1), 1.0);
  return std::abs(line.dot(Eigen::Vector3d(At(match, 2), At(match, 3), 1.0))) / line.head<2>().norm();
}

TEST(TrialAsJson, TrueLinesGoThroughTrueMatchesAndMissWrongOnes) {
  // The estimators assume a wrong focal length: the truth's lines are those of the true cameras.
  for (const char* cameras : {"pinhole", "euroc_and_office"}) {
    const StudyPlan plan = PlanWith({{"sigma_px", "1e-7"}, {"cameras", cameras}, {"focal_error", "0.1"}});
    const Json json = ParseTrialJson(plan, RunLast(plan));
    const Eigen::Matrix3d F = MatrixFrom(json["truth"]["F"]);
    int num_missed = 0, num_wrong = 0;
    for (size_t i = 0; i < json["matches"].size(); ++i) {
      const double distance_px = DistanceFromLine(F, json["matches"][i]);
      const bool is_wrong = json["kinds"][i] == "outlier";
      num_wrong += is_wrong;
      num_missed += is_wrong && distance_px > 1.0;
      EXPECT_TRUE(is_wrong || distance_px < 1e-5) << distance_px;
    }
    EXPECT_EQ(num_wrong, 18);  // 30 % of 60
    EXPECT_GE(num_missed, 15);
  }
}

TEST(TrialAsJson, EstimatedLinesAreThoseOfTheCamerasTheEstimatorIsTold) {
  const StudyPlan plan = PlanWith({{"focal_error", "0.1"}, {"image_width", "800"}});
  const TrialResult result = RunAnswered(plan);
  ASSERT_EQ(result.estimates[1].status, MotionStatus::kOk);
  const Json json = ParseTrialJson(plan, result);
  const Eigen::Matrix3d F = MatrixFrom(json["estimators"][1]["F"]);
  const Eigen::Matrix3d R = MatrixFrom(json["estimators"][1]["R"]);
  const Eigen::Vector3d t = VectorFrom(json["estimators"][1]["t"]);
  const Eigen::Matrix3d K1 = result.data.problem.camera1.K(), K2 = result.data.problem.camera2.K();
  EXPECT_LT((K2.transpose() * F * K1 - CrossMatrix(t) * R).norm(), 1e-9);
  EXPECT_EQ(json["cameras"][0]["fx"], 700.0);
  EXPECT_NEAR(result.data.problem.camera1.fx, 770.0, 1e-9);
}

TEST(TrialAsJson, EveryMatchKnowsItsPointOfTheScene) {
  const StudyPlan plan = PlanWith({{"sigma_px", "1e-7"}});
  const TrialResult result = RunLast(plan, 3);
  const Json json = ParseTrialJson(plan, result);
  ASSERT_EQ(json["points_in_cam1_m"].size(), 60u);
  const Camera& camera = result.data.problem.camera1;
  int num_true = 0;
  for (size_t i = 0; i < 60; ++i) {
    if (json["kinds"][i] != "inlier") continue;
    const Json& match = json["matches"][i];
    const Eigen::Vector2d x1_px(At(match, 0), At(match, 1));
    EXPECT_LT((camera.Project(VectorFrom(json["points_in_cam1_m"][i])) - x1_px).norm(), 1e-5);
    ++num_true;
  }
  EXPECT_EQ(num_true, 42);
}

TEST(TrialAsJson, ShowsWhereTheCamerasAre) {
  const StudyPlan plan = MakePlan(SmallStudy());
  const TrialResult result = RunLast(plan);
  const Json json = ParseTrialJson(plan, result);
  const RelativePose& pose = *result.data.truth.cam2_from_cam1_true;
  const double baseline_m = json["truth"]["baseline_m"];
  EXPECT_GT(baseline_m, 0.0);
  // Camera 2's centre is the origin of its own frame; the ray of its left edge looks at its left edge.
  const Eigen::Vector3d centre2 = VectorFrom(json["views"][1]["centre_in_cam1_m"]);
  EXPECT_LT((pose.R * centre2 + baseline_m * pose.t).norm(), 1e-12);
  const Eigen::Vector3d left = pose.R * VectorFrom(json["views"][1]["edges_in_cam1"][0]);
  EXPECT_NEAR(result.data.problem.camera2.Project(left).x(), -0.5, 1e-9);
  EXPECT_EQ(VectorFrom(json["views"][0]["centre_in_cam1_m"]), Eigen::Vector3d::Zero());

  const RelativePose& estimated = result.estimates[1].cam2_from_cam1;
  const Eigen::Vector3d estimated_centre2 = VectorFrom(json["estimators"][1]["centre2_in_cam1_m"]);
  EXPECT_LT((estimated.R * estimated_centre2 + baseline_m * estimated.t).norm(), 1e-12);
}

TEST(TrialAsJson, SaysWhichTrialItIsAndHowItEnded) {
  const StudyPlan plan = MakePlan(SmallStudy());
  const TrialResult result = RunAnswered(plan);
  const Json json = ParseTrialJson(plan, result, {1, 0});
  EXPECT_EQ(json["format"], "rcme trial 2");
  EXPECT_EQ(json["study"], "small");
  EXPECT_EQ(json["seed"], 3);
  EXPECT_EQ(json["condition"], 1);
  EXPECT_EQ(json["trial"], result.problem.trial);
  EXPECT_EQ(json["factors"], Json::parse(R"([["outlier_ratio", "0.3"]])"));
  EXPECT_EQ(json["parts"][0], Json::parse(R"(["scene", "uniform_volume"])"));
  EXPECT_EQ(json["parts"][2], Json::parse(R"(["motion", "general"])"));
  EXPECT_EQ(json["drawn"], Json::parse("[1, 0]"));
  EXPECT_EQ(json["severity"]["crb_rotation_deg"], result.problem.severity.crb_rotation_deg);
  for (size_t e = 0; e < 2; ++e) {
    EXPECT_EQ(json["estimators"][e]["label"], plan.study.estimators[e].label);
    EXPECT_EQ(json["estimators"][e]["inliers"], Json(result.estimates[e].inliers));
    const HypothesisId& id = result.estimates[e].hypothesis;
    EXPECT_EQ(json["estimators"][e]["hypothesis"]["sample"],
              Json(std::vector<int>(id.sample.begin(), id.sample.end())));
    EXPECT_EQ(id.sample.size(), 8);
    EXPECT_EQ(json["estimators"][e]["hypothesis"]["model"], 0);
    EXPECT_EQ(json["estimators"][e]["rotation_error_deg"],
              Json(JsonNumber(result.records[e].rotation_error_deg)));
  }
  EXPECT_EQ(TrialAsJson(plan, RunLast(plan, result.problem.trial), {1, 0}),
            TrialAsJson(plan, result, {1, 0}));
}

TEST(TrialAsJson, SelectsTrueInliersThatAreSpreadOverTheImage) {
  const StudyPlan plan = MakePlan(SmallStudy());
  const TrialResult result = RunLast(plan);
  const auto selected = ParseTrialJson(plan, result)["selected"].get<std::vector<int>>();
  ASSERT_EQ(selected.size(), 8u);
  const auto distance_from_chosen = [&](int i, size_t num_chosen) {
    double distance_px = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < num_chosen; ++k) {
      const auto& matches = result.data.problem.matches;
      const Eigen::Vector2d between_px = matches.at(size_t(i)).x1_px - matches.at(size_t(selected[k])).x1_px;
      distance_px = std::min(distance_px, between_px.norm());
    }
    return distance_px;
  };
  for (size_t k = 0; k < selected.size(); ++k) {
    EXPECT_TRUE(result.data.truth.is_inlier_true.at(size_t(selected[k])));
    for (int i = 0; k > 0 && i < 60; ++i) {
      if (!result.data.truth.is_inlier_true[size_t(i)]) continue;
      EXPECT_LE(distance_from_chosen(i, k), distance_from_chosen(selected[k], k));
    }
  }
}

TEST(TrialAsJson, NoTrueMatchesNothingToSelect) {
  const StudyPlan plan = PlanWith({{"outlier_ratio", "1"}});
  const Json json = ParseTrialJson(plan, RunLast(plan));
  EXPECT_EQ(json["selected"], Json::array());
  EXPECT_EQ(std::ranges::count(json["kinds"], "inlier"), 0);
}

TEST(TrialAsJson, APureRotationHasNoDirectionAndNoTrueLines) {
  const StudyPlan plan = PlanWith({{"motion", "pure_rotation"}});
  const Json json = ParseTrialJson(plan, RunLast(plan));
  EXPECT_TRUE(json["truth"]["t"].is_null());
  EXPECT_TRUE(json["truth"]["F"].is_null());
  EXPECT_FALSE(json["truth"]["R"].is_null());
  EXPECT_EQ(json["truth"]["baseline_m"], 0.0);
  EXPECT_EQ(VectorFrom(json["views"][1]["centre_in_cam1_m"]).norm(), 0.0);
  for (const Json& estimator : json["estimators"]) {
    EXPECT_TRUE(estimator["centre2_in_cam1_m"].is_null());
    EXPECT_TRUE(estimator["direction_error_deg"].is_null());
  }
}

class RefusingEstimator : public MotionEstimator {
 public:
  MotionEstimate Estimate(const MotionProblem&, RandomStream&) const override {
    MotionEstimate estimate;
    estimate.status = MotionStatus::kNoCandidate;
    estimate.message = "no, thank you";
    return estimate;
  }
};

TEST(TrialAsJson, ARefusalHasItsReasonAndNoMotion) {
  StudyPlan plan = MakePlan(SmallStudy());
  plan.estimators[1] = std::make_shared<RefusingEstimator>();
  const TrialResult result = RunLast(plan);
  const Json refusal = ParseTrialJson(plan, result)["estimators"][1];
  EXPECT_EQ(refusal["outcome"], "refusal");
  EXPECT_EQ(refusal["status"], "no_candidate");
  EXPECT_EQ(refusal["message"], "no, thank you");
  EXPECT_EQ(refusal["inliers"], Json::array());
  for (const char* key : {"R", "t", "F", "centre2_in_cam1_m", "rotation_error_deg", "inlier_recall"}) {
    EXPECT_TRUE(refusal[key].is_null()) << key;
  }
}

// Indices of an estimator of a user's own are looked at before they are used.
TEST(TrialAsJson, AnInvalidAnswerIsAFailureWithItsReasonAndNoMotion) {
  StudyPlan plan = MakePlan(SmallStudy());
  plan.estimators[0] = std::make_shared<FaultyEstimator>(
      [](MotionEstimate& estimate) { estimate.inliers.push_back(1'000'000'000); });
  const TrialResult result = RunAnswered(plan);
  ASSERT_EQ(result.records[0].status, MotionStatus::kInvalidMotion);
  EXPECT_EQ(MostTelling(plan, result), 0u);
  const Json json = ParseTrialJson(plan, result)["estimators"][0];
  EXPECT_EQ(json["outcome"], "failure");
  EXPECT_EQ(json["status"], "invalid_motion");
  EXPECT_EQ(json["message"], "inlier 1000000000 is not an index of one of the 60 matches");
  EXPECT_EQ(json["inliers"], Json::array());
  EXPECT_TRUE(json["R"].is_null() && json["F"].is_null());
  EXPECT_NE(TrialAsText(plan, result).find("failure"), std::string::npos);
}

TEST(TrialAsJson, RealPairsHaveNeitherSceneNorLabels) {
  const TempFolder folder;
  folder.Write("pair.csv", MatchHeader() + TruePoseHeader() + MatchRows(40));
  const StudyPlan plan = MakePlan(
      ParseStudy("data: {scene: match_files, folder: " + folder.path() + "}\nestimators: [{name: rcme}]\n",
                 "real.yaml"));
  const TrialResult result = RunLast(plan);
  const Json json = ParseTrialJson(plan, result);
  for (const char* key : {"kinds", "points_in_cam1_m", "views"}) EXPECT_TRUE(json[key].is_null()) << key;
  EXPECT_TRUE(json["truth"]["baseline_m"].is_null());
  const Eigen::Matrix3d F = MatrixFrom(json["truth"]["F"]);
  for (const Json& match : json["matches"]) EXPECT_LT(DistanceFromLine(F, match), 1e-3);
  EXPECT_EQ(json["origin"], "pair.csv");
  // What nobody knows to be true is chosen among what the drawn estimator takes for true.
  const auto selected = json["selected"].get<std::vector<int>>();
  const auto inliers = json["estimators"][0]["inliers"].get<std::vector<int>>();
  EXPECT_EQ(selected.size(), std::min<size_t>(8, inliers.size()));
  for (const int i : selected) EXPECT_THAT(inliers, testing::Contains(i));
}

TEST(MostTelling, IsTheFirstThatFailedOrRefusedElseTheFirst) {
  StudyPlan plan = MakePlan(SmallStudy());
  TrialResult result = RunTrial(plan, plan.conditions[0], 0);  // no wrong matches
  EXPECT_EQ(MostTelling(plan, result), 0u);
  result.records[1].rotation_error_deg = 90.0;
  EXPECT_EQ(MostTelling(plan, result), 1u);
  result.records[0].status = MotionStatus::kNoCandidate;
  EXPECT_EQ(MostTelling(plan, result), 0u);
}

TEST(TrialAsText, NamesLevelsSeverityAndOutcomes) {
  const StudyPlan plan = MakePlan(SmallStudy());
  const std::string text = TrialAsText(plan, RunLast(plan));
  for (const char* part :
       {"Study small, seed 3, condition 1, trial 0", "outlier_ratio = 0.3", "motion general, noise gaussian",
        "60 matches: 42 true, 18 wrong", "crb_direction_deg", "standard", "ours", "precision"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_THAT(text, Not(HasSubstr("beyond")));
  EXPECT_THAT(TrialAsText(plan, RunLast(plan, 6)), HasSubstr("beyond the 6 trials the study asks for"));
}

}  // namespace
}  // namespace rcme
