#include "experiments/real/answer/why.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "estimator/estimators/rcme_calibrated.h"
#include "estimator/loop_inspection.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"

namespace rcme {
namespace {

// How many trials of the one estimator of a study ended why.
struct Verdicts {
  std::map<WhyVerdict, int> of_failures, of_refusals;
  int num_right = 0;
  std::string last_words;
};

Verdicts CollectVerdicts(const std::string& data, const std::string& estimator, int trials) {
  const StudyPlan plan = MakePlan(
      ParseStudy("name: why\nseed: 1\ndata: {" + data + "}\nestimators: [" + estimator + "]\n", "why.yaml"));
  Verdicts verdicts;
  for (int trial = 0; trial < trials; ++trial) {
    const TrialResult result = RunTrial(plan, plan.conditions[0], static_cast<std::uint32_t>(trial));
    const Why why = ExplainOutcome(plan.study.estimators[0], result.data, result.estimates[0],
                                   result.records[0], plan.study.failure);
    verdicts.last_words = why.words;
    if (HasSucceeded(result.records[0], plan.study.failure)) {
      EXPECT_EQ(why.verdict, WhyVerdict::kRight);
      ++verdicts.num_right;
    } else if (HasRefused(result.records[0])) {
      ++verdicts.of_refusals[why.verdict];
    } else {
      ++verdicts.of_failures[why.verdict];
    }
  }
  return verdicts;
}

const std::string kEasy = "scene: uniform_volume, num_matches: 100, sigma_px: 0.5, outlier_ratio: 0.5";

// One sample of eight matches, half of them wrong: right with probability 1/256. The true motion explains all
// right matches, so whatever goes wrong is the search's.
TEST(Why, TooFewSamplesAreAFailureOfTheSearch) {
  for (const std::string name : {"standard", "msac", "mlesac", "rcme"}) {
    std::string entry = "{name: ";
    entry += name + ", options: {num_iterations: 1}}";
    const Verdicts verdicts = CollectVerdicts(kEasy, entry, 12);
    int num_search = 0, num_other = 0;
    for (const auto& of : {verdicts.of_failures, verdicts.of_refusals}) {
      for (const auto& [verdict, count] : of)
        (verdict == WhyVerdict::kSearchFailed ? num_search : num_other) += count;
    }
    // The robust refinement now and then finds the way from a sample with a wrong match.
    EXPECT_LE(verdicts.num_right, 3) << name;
    EXPECT_LE(num_other, 1) << name << ": " << verdicts.last_words;
    EXPECT_GE(num_search, 8) << name << ": " << verdicts.last_words;
  }
}

// Eight samples of five, three quarters of the matches wrong: one of right matches alone with probability
// 0.01.
TEST(Why, TooFewSamplesOfTheCalibratedOne) {
  const Verdicts verdicts =
      CollectVerdicts("scene: uniform_volume, num_matches: 200, sigma_px: 0.5, outlier_ratio: 0.75",
                      "{name: rcme_calibrated, options: {min_samples: 8, max_samples: 8}}", 12);
  int num_search = 0, num_all = 0;
  for (const auto& of : {verdicts.of_failures, verdicts.of_refusals}) {
    for (const auto& [verdict, count] : of) {
      num_all += count;
      num_search += verdict == WhyVerdict::kSearchFailed ? count : 0;
    }
  }
  EXPECT_GE(num_all, 6);
  EXPECT_GE(num_search, num_all - 1) << verdicts.last_words;
}

// Points of one plane have two motions, and no number of samples tells which is right.
TEST(Why, APlaneIsMoreThanTheModelCanTell) {
  const std::string plane = "scene: plane, num_matches: 100, sigma_px: 0.5";
  for (const std::string name : {"standard", "msac"}) {
    std::string entry = "{name: ";
    entry += name + ", options: {solver: five_point, num_iterations: 300}}";
    const Verdicts verdicts = CollectVerdicts(plane, entry, 16);
    const auto found = verdicts.of_failures.find(WhyVerdict::kModelCannotTell);
    ASSERT_NE(found, verdicts.of_failures.end()) << name;
    EXPECT_GE(found->second, 3) << name;
    for (const auto& [verdict, count] : verdicts.of_failures) {
      if (verdict == WhyVerdict::kModelCannotTell) continue;
      EXPECT_LE(count, 1) << name << " " << Name(verdict);
    }
  }
}

TEST(Why, ABaselineWithinTheNoiseIsMoreThanTheModelCanTell) {
  const Verdicts verdicts =
      CollectVerdicts("scene: uniform_volume, motion: vanishing_baseline, num_matches: 100, sigma_px: 0.5",
                      "{name: standard, options: {solver: five_point, num_iterations: 300}}", 12);
  ASSERT_FALSE(verdicts.of_failures.empty());
  for (const auto& [verdict, count] : verdicts.of_failures) {
    EXPECT_EQ(verdict, WhyVerdict::kModelCannotTell) << count << " " << verdicts.last_words;
  }
}

TEST(Why, AGoodAnswerIsRight) {
  for (const std::string name : {"standard", "rcme_calibrated"}) {
    std::string entry = "{name: ";
    entry += name + "}";
    const Verdicts verdicts =
        CollectVerdicts("scene: uniform_volume, num_matches: 100, sigma_px: 0.5", entry, 6);
    EXPECT_EQ(verdicts.num_right, 6) << name;
  }
}

// An estimator whose score is not known is judged by another, and so it says.
TEST(Why, SaysWhoseScoreItIs) {
  const Verdicts verdicts = CollectVerdicts(
      kEasy, "{name: lo_ransac, options: {num_iterations: 1, inner_samples: 0, inner_refits: 0}}", 3);
  EXPECT_THAT(verdicts.last_words, testing::HasSubstr("in place of its own score"));
}

// A motion that the search did find is scored as the search scored it: what is handed in is judged by the
// same tests and numbers.
TEST(ScoreMotion, GivesTheAnswerItsOwnAnswer) {
  const StudyPlan plan = MakePlan(ParseStudy(
      "data: {scene: uniform_volume, num_matches: 120, outlier_ratio: 0.3}\n"
      "estimators: [{name: standard}, {name: rcme, options: {reading: rank_aware}}, {name: msac},\n"
      "  {name: standard, label: five, options: {solver: five_point}}]\n",
      "score.yaml"));
  for (std::uint32_t trial = 0; trial < 4; ++trial) {
    const TrialResult result = RunTrial(plan, plan.conditions[0], trial);
    for (size_t e = 0; e < plan.estimators.size(); ++e) {
      const MotionEstimate& answer = result.estimates[e];
      if (answer.status != MotionStatus::kOk) continue;
      const ScoredMotion scored =
          FindInspection(*plan.estimators[e])->ScoreMotion(result.data.problem, answer.cam2_from_cam1);
      ASSERT_TRUE(scored.refined.converged);
      // The same optimum: the robust refinement from there ends there, to what its last step leaves.
      EXPECT_LT(LocalCoordinates(answer.cam2_from_cam1, scored.refined.cam2_from_cam1).norm(), 1e-3);
      EXPECT_NEAR(scored.estimate.num_explained, answer.num_explained, 2);
      EXPECT_GT(scored.score.num_inliers, 60);
    }
  }
}

// Handed the truth, rcme_calibrated is sure where there is one motion, and often not where there are two.
TEST(WeighMotions, OneMotionOrTwo) {
  const auto num_sure = [](const std::string& scene) {
    std::string yaml = "data: {scene: ";
    yaml += scene + ", num_matches: 150}\nestimators: [{name: rcme_calibrated}]\n";
    const StudyPlan plan = MakePlan(ParseStudy(yaml, "weigh.yaml"));
    int count = 0;
    for (std::uint32_t trial = 0; trial < 12; ++trial) {
      const TrialData data = plan.conditions[0].source->Make(NameOfScene(plan, plan.conditions[0], trial));
      double sum = 0.0, greatest = 0.0;
      for (const WeighedMotion& motion :
           FindWeightInspection(*plan.estimators[0])
               ->WeighMotions(data.problem, {*data.truth.cam2_from_cam1_true})) {
        sum += motion.weight;
        greatest = std::max(greatest, motion.weight);
      }
      EXPECT_LE(sum, 1.0 + 1e-9);
      count += greatest > 0.9;
    }
    return count;
  };
  EXPECT_GE(num_sure("uniform_volume"), 11);
  EXPECT_LE(num_sure("plane"), 9);
}

}  // namespace
}  // namespace rcme
