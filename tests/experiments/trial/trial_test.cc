#include "experiments/trial/trial.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <memory>
#include <set>

#include "experiments/data/simulated_data.h"
#include "experiments/trial/covariance_score.h"
#include "stats/consistency.h"
#include "stats/constants.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

std::string AllBits(const TrialResult& result) {
  std::string text;
  for (const TrialRecord& record : result.records) text += RecordText(record) + "\n";
  for (const MotionEstimate& estimate : result.estimates) {
    text += fmt::format("{} {} {}\n", estimate.message, fmt::join(estimate.cam2_from_cam1.R.reshaped(), " "),
                        fmt::join(estimate.pose_cov.reshaped(), " "));
  }
  for (const Correspondence& m : result.data.problem.matches) {
    text += fmt::format("{} {} {} {}\n", m.x1_px.x(), m.x1_px.y(), m.x2_px.x(), m.x2_px.y());
  }
  return text;
}

TEST(RunTrial, IsAPureFunctionOfItsName) {
  const StudyPlan plan = MakePlan(SmallStudy()), same_plan = MakePlan(SmallStudy());
  for (const size_t condition : {0, 1}) {
    const std::string first = AllBits(RunTrial(plan, plan.conditions[condition], 5));
    RunTrial(plan, plan.conditions[condition], 4);
    EXPECT_EQ(AllBits(RunTrial(plan, plan.conditions[condition], 5)), first);
    EXPECT_EQ(AllBits(RunTrial(same_plan, same_plan.conditions[condition], 5)), first);
  }
}

TEST(RunTrial, DiffersWithSeedConditionAndTrial) {
  Study study = SmallStudy();
  const StudyPlan plan = MakePlan(study);
  study.seed = 4;
  const StudyPlan other_seed = MakePlan(study);
  const auto first_match = [](const StudyPlan& p, size_t condition, std::uint32_t trial) {
    return RunTrial(p, p.conditions[condition], trial).data.problem.matches[0].x1_px.x();
  };
  const std::set<double> distinct = {first_match(plan, 0, 0), first_match(plan, 0, 1),
                                     first_match(plan, 1, 0), first_match(plan, 1, 1),
                                     first_match(other_seed, 0, 0)};
  EXPECT_EQ(distinct.size(), 5u);
}

TEST(RunTrial, RecordsCarryTheirNames) {
  const StudyPlan plan = MakePlan(SmallStudy());
  const TrialResult result = RunTrial(plan, plan.conditions[1], 7);
  ASSERT_EQ(result.records.size(), 2u);
  ASSERT_EQ(result.estimates.size(), 2u);
  for (std::uint32_t e = 0; e < 2; ++e) {
    EXPECT_EQ(result.records[e].condition, 1u);
    EXPECT_EQ(result.records[e].trial, 7u);
    EXPECT_EQ(result.records[e].estimator, e);
    EXPECT_EQ(result.records[e].num_matches, 60);
    EXPECT_GT(result.records[e].seconds, 0.0);
  }
}

// Remembers what it was given.
class SpyEstimator : public MotionEstimator {
 public:
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    last_problem = problem;
    last_draw = rng.Next64();
    return {};
  }
  mutable MotionProblem last_problem;
  mutable std::uint64_t last_draw = 0;
};

TEST(RunTrial, EveryEstimatorSeesTheSameProblemAndTheSameSamples) {
  StudyPlan plan = MakePlan(SmallStudy());
  const auto first = std::make_shared<SpyEstimator>(), second = std::make_shared<SpyEstimator>();
  plan.estimators = {first, second};
  const TrialResult result = RunTrial(plan, plan.conditions[1], 2);
  EXPECT_EQ(first->last_draw, second->last_draw);
  ASSERT_EQ(first->last_problem.matches.size(), 60u);
  for (size_t i = 0; i < 60; ++i) {
    for (const auto& spy : {first, second}) {
      EXPECT_EQ(spy->last_problem.matches[i].x1_px, result.data.problem.matches[i].x1_px);
      EXPECT_EQ(spy->last_problem.matches[i].x2_px, result.data.problem.matches[i].x2_px);
    }
  }
  EXPECT_EQ(first->last_problem.sigma_px, 0.5);
  EXPECT_EQ(first->last_problem.camera1.K(), second->last_problem.camera1.K());
}

TEST(RunTrial, TheEstimatorsOfAStudyDoNotDisturbEachOther) {
  Study alone = SmallStudy();
  alone.estimators.erase(alone.estimators.begin());
  const StudyPlan both_plan = MakePlan(SmallStudy()), alone_plan = MakePlan(alone);
  TrialRecord of_both = RunTrial(both_plan, both_plan.conditions[1], 3).records[1];
  of_both.estimator = 0;
  EXPECT_EQ(RecordText(RunTrial(alone_plan, alone_plan.conditions[1], 3).records[0]), RecordText(of_both));
}

TEST(StreamFor, PurposesShareNoNumbers) {
  std::set<std::uint64_t> words;
  for (const StreamPurpose purpose :
       {StreamPurpose::kScene, StreamPurpose::kNoise, StreamPurpose::kOutliers, StreamPurpose::kSampling,
        StreamPurpose::kMonteCarlo, StreamPurpose::kCheck}) {
    RandomStream rng = StreamFor({1, 2, 3, 99}, purpose);
    for (int i = 0; i < 100; ++i) words.insert(rng.Next64());
  }
  EXPECT_EQ(words.size(), 600u);
}

// Drawn errors of a truth along camera 2's axes scatter as CovarianceAt says, in the tangent at the estimate:
// mean NEES 5 of 4,000 truths, z-test at 1e-4; an sd of the rotation that is 5 % off, or axes that are
// exchanged, are seen.
TEST(TruthSd, IsTheCovarianceOfTruthsThatAreOff) {
  const RelativePose pose{RotationFromVector({0.3, -0.5, 0.2}), Eigen::Vector3d(0.6, -0.3, 0.7).normalized()};
  const TruthSd sd{{0.001, 0.002, 0.004}, {0.004, 0.001, 0.002}};
  const auto z_of = [&](const TruthSd& stated) {
    RandomStream rng({.seed = 1, .purpose = 70});
    double sum = 0.0;
    for (int i = 0; i < 4000; ++i) {
      const Eigen::Vector3d w =
          Eigen::Vector3d(rng.Normal(), rng.Normal(), rng.Normal()).cwiseProduct(sd.rotation_rad);
      const Eigen::Vector3d e =
          Eigen::Vector3d(rng.Normal(), rng.Normal(), rng.Normal()).cwiseProduct(sd.translation);
      const RelativePose off{RotationFromVector(w) * pose.R, (pose.t + e).normalized()};
      sum += NormalizedErrorSquared(LocalCoordinates(pose, off), stated.CovarianceAt(pose));
    }
    return (sum / 4000 - 5.0) / std::sqrt(10.0 / 4000);
  };
  EXPECT_LT(std::abs(z_of(sd)), 3.89);
  EXPECT_GT(std::abs(z_of({1.05 * sd.rotation_rad, sd.translation})), 3.0) << "no power";
  EXPECT_GT(std::abs(z_of({sd.rotation_rad, {0.001, 0.004, 0.002}})), 3.89) << "no power";
}

// Six matches, the first four true; the true motion is R = I, t = x.
TrialData HandMadeData() {
  TrialData data;
  data.problem.matches.resize(6);
  data.truth.cam2_from_cam1_true = RelativePose{};
  data.truth.is_inlier_true = {true, true, true, true, false, false};
  return data;
}

MotionEstimate HandMadeEstimate(double rotation_error_deg, double direction_error_deg) {
  MotionEstimate estimate;
  estimate.status = MotionStatus::kOk;
  estimate.cam2_from_cam1.R = RotationFromVector({0.0, rotation_error_deg * kRadPerDeg, 0.0});
  const double angle = direction_error_deg * kRadPerDeg;
  estimate.cam2_from_cam1.t = {std::cos(angle), 0.0, std::sin(angle)};
  estimate.pose_cov = Matrix5d::Identity() * kRadPerDeg * kRadPerDeg;
  estimate.inliers = {0, 1, 4};
  return estimate;
}

TEST(Score, ErrorsByHand) {
  const TrialRecord record = Score(HandMadeEstimate(2.0, 5.0), HandMadeData(), 0.25);
  EXPECT_EQ(record.status, MotionStatus::kOk);
  EXPECT_NEAR(record.rotation_error_deg, 2.0, 1e-9);
  EXPECT_NEAR(record.direction_error_deg, 5.0, 1e-9);
  EXPECT_NEAR(record.nees, 2.0 * 2.0 + 5.0 * 5.0, 1e-6);  // the covariance is 1 deg^2 in each coordinate
  EXPECT_EQ(record.num_matches, 6);
  EXPECT_EQ(record.num_inliers, 3);
  EXPECT_DOUBLE_EQ(record.inlier_precision, 2.0 / 3.0);  // 0 and 1 of {0, 1, 4}
  EXPECT_DOUBLE_EQ(record.inlier_recall, 2.0 / 4.0);     // of {0, 1, 2, 3}
  EXPECT_EQ(record.seconds, 0.25);
}

// NEES is of the truth's coordinates around the estimate, where the covariance is, and not the other way
// round: 25 deg apart the two bases of the direction differ. A covariance that tells all axes apart, so that
// no order and no sign can be exchanged.
// The truth's variance adds to the estimate's, 1 deg^2 along each axis.
TEST(Score, NeesHasTheErrorOfTheTruthInIt) {
  TrialData data = HandMadeData();
  data.truth.sd =
      TruthSd{Eigen::Vector3d::Constant(2.0 * kRadPerDeg), Eigen::Vector3d::Constant(3.0 * kRadPerDeg)};
  const TrialRecord record = Score(HandMadeEstimate(2.0, 5.0), data, 0.0);
  EXPECT_NEAR(record.nees, 2.0 * 2.0 / (1.0 + 4.0) + 5.0 * 5.0 / (1.0 + 9.0), 1e-6);
  EXPECT_NEAR(record.rotation_error_deg, 2.0, 1e-9);
}

TEST(Score, NeesIsTakenAtTheEstimate) {
  TrialData data = HandMadeData();
  MotionEstimate estimate = HandMadeEstimate(0.0, 0.0);
  estimate.cam2_from_cam1 = {RotationFromVector({0.3, -0.2, 0.1}),
                             Eigen::Vector3d(0.2, 0.5, 0.7).normalized()};
  Vector5d error;  // [rotation, direction], rad
  error << 0.02, -0.05, 0.03, 0.4, -0.2;
  data.truth.cam2_from_cam1_true = Retract(estimate.cam2_from_cam1, error);
  Matrix5d root = Matrix5d::Zero();
  for (int row = 0; row < 5; ++row) {
    for (int col = 0; col <= row; ++col)
      root(row, col) = row == col ? 0.1 + 0.07 * row : 0.02 * (row - 2 * col);
  }
  estimate.pose_cov = root * root.transpose();
  const double expected = error.dot(estimate.pose_cov.inverse() * error);
  const double exchanged = NormalizedErrorSquared(
      LocalCoordinates(*data.truth.cam2_from_cam1_true, estimate.cam2_from_cam1), estimate.pose_cov);
  EXPECT_GT(std::abs(exchanged - expected), 0.05 * expected) << "no power";
  EXPECT_NEAR(Score(estimate, data, 0.0).nees, expected, 1e-9 * expected);
  EXPECT_NEAR(
      NormalizedErrorOfPose(estimate.cam2_from_cam1, estimate.pose_cov, *data.truth.cam2_from_cam1_true),
      expected, 1e-9 * expected);
}

// A wrong match on the true epipolar line is no wrong inlier: no epipolar test can tell it.
TEST(Score, UndetectableMatchesAreNotCountedAsWrong) {
  TrialData data = HandMadeData();  // 0 to 3 are true, 4 and 5 wrong
  data.truth.is_undetectable = {false, false, false, false, true, false};
  MotionEstimate estimate = HandMadeEstimate(0.0, 0.0);
  const auto precision_of = [&](const std::vector<int>& inliers) {
    estimate.inliers = inliers;
    return Score(estimate, data, 0.0).inlier_precision;
  };
  EXPECT_EQ(precision_of({0, 1, 4}), 1.0);
  EXPECT_DOUBLE_EQ(precision_of({0, 1, 5}), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(precision_of({0, 1, 4, 5}), 2.0 / 3.0);
  EXPECT_TRUE(std::isnan(precision_of({4})));
  EXPECT_EQ(Score(estimate, data, 0.0).inlier_recall, 0.0);
}

TEST(Score, ThePointOnTheOtherSideOfTheSphere) {
  EXPECT_NEAR(Score(HandMadeEstimate(0.0, 180.0), HandMadeData(), 0.0).direction_error_deg, 180.0, 1e-6);
  EXPECT_NEAR(Score(HandMadeEstimate(180.0, 0.0), HandMadeData(), 0.0).rotation_error_deg, 180.0, 1e-6);
}

TEST(Score, SuccessAndFailureAtTheBounds) {
  const FailureBounds bounds{3.0, 15.0};
  const auto outcome = [&](double rotation_deg, double direction_deg) {
    TrialRecord record;
    record.status = MotionStatus::kOk;
    record.rotation_error_deg = rotation_deg;
    record.direction_error_deg = direction_deg;
    EXPECT_NE(HasFailed(record, bounds), HasSucceeded(record, bounds));
    return HasSucceeded(record, bounds);
  };
  EXPECT_TRUE(outcome(0.0, 0.0));
  EXPECT_TRUE(outcome(3.0, 15.0));  // at the bound is within it
  EXPECT_FALSE(outcome(std::nextafter(3.0, 4.0), 0.0));
  EXPECT_FALSE(outcome(0.0, std::nextafter(15.0, 16.0)));
  EXPECT_FALSE(outcome(4.0, 16.0));
  EXPECT_FALSE(outcome(14.0, 2.0)) << "each error against its own bound";
  EXPECT_TRUE(outcome(1.0, std::numeric_limits<double>::quiet_NaN()));  // direction unknown: rotation decides
  EXPECT_FALSE(outcome(4.0, std::numeric_limits<double>::quiet_NaN()));
}

TEST(Score, NoMotionIsNeitherSuccessNorFailure) {
  for (const MotionStatus status : AllStatuses()) {
    if (status == MotionStatus::kOk || status == MotionStatus::kDirectionNotObservable ||
        status == MotionStatus::kInvalidMotion || status == MotionStatus::kInvalidCovariance) {
      continue;
    }
    MotionEstimate estimate = HandMadeEstimate(40.0, 80.0);  // whatever is left in it must not be scored
    estimate.status = status;
    const TrialRecord record = Score(estimate, HandMadeData(), 0.0);
    EXPECT_EQ(record.status, status);
    for (const double unknown : {record.rotation_error_deg, record.direction_error_deg, record.nees,
                                 record.inlier_precision, record.inlier_recall}) {
      EXPECT_TRUE(std::isnan(unknown)) << StatusName(status);
    }
    const bool is_counted = status != MotionStatus::kNotSimulated && status != MotionStatus::kTruthInDoubt;
    EXPECT_EQ(HasRefused(record), is_counted) << StatusName(status);
    EXPECT_FALSE(HasFailed(record, {}) || HasSucceeded(record, {})) << StatusName(status);
  }
}

// A refusal whose rotation is scored beside it.
TEST(Score, ADirectionThatIsNotObservableStillHasARotation) {
  MotionEstimate estimate = HandMadeEstimate(2.0, 80.0);
  estimate.status = MotionStatus::kDirectionNotObservable;
  estimate.cam2_from_cam1.t.setConstant(std::numeric_limits<double>::quiet_NaN());
  const TrialRecord record = Score(estimate, HandMadeData(), 0.0);
  EXPECT_EQ(record.status, MotionStatus::kDirectionNotObservable);
  EXPECT_NEAR(record.rotation_error_deg, 2.0, 1e-9);
  EXPECT_TRUE(std::isnan(record.direction_error_deg) && std::isnan(record.nees));
  EXPECT_TRUE(HasRefused(record));
  EXPECT_FALSE(HasFailed(record, {}) || HasSucceeded(record, {}));
  estimate.cam2_from_cam1.R *= 2.0;
  EXPECT_EQ(Score(estimate, HandMadeData(), 0.0).status, MotionStatus::kInvalidMotion);
}

// A failure, and no cover, whatever is left in it: NEES is infinite, not missing.
TEST(Score, AnInvalidAnswerIsAFailureThatDoesNotCover) {
  MotionEstimate estimate = HandMadeEstimate(0.0, 0.0);  // the truth itself
  estimate.pose_cov(2, 2) = std::numeric_limits<double>::quiet_NaN();
  const TrialRecord no_covariance = Score(estimate, HandMadeData(), 0.0);
  EXPECT_EQ(no_covariance.status, MotionStatus::kInvalidCovariance);
  EXPECT_NEAR(no_covariance.rotation_error_deg, 0.0, 1e-6);
  EXPECT_NEAR(no_covariance.direction_error_deg, 0.0, 1e-6);
  estimate.cam2_from_cam1.R.col(0) *= -1.0;  // a reflection
  const TrialRecord no_motion = Score(estimate, HandMadeData(), 0.0);
  EXPECT_EQ(no_motion.status, MotionStatus::kInvalidMotion);
  EXPECT_TRUE(std::isnan(no_motion.rotation_error_deg) && std::isnan(no_motion.direction_error_deg));
  TrialData no_truth = HandMadeData();
  no_truth.truth = {};
  const TrialRecord unknown = Score(estimate, no_truth, 0.0);
  EXPECT_TRUE(std::isnan(unknown.nees));
  EXPECT_EQ(no_covariance.nees, kInfinity);
  EXPECT_EQ(no_motion.nees, kInfinity);
  for (const TrialRecord& record : {no_covariance, no_motion, unknown}) {
    EXPECT_TRUE(HasFailed(record, {}) && IsScored(record));
    EXPECT_FALSE(HasRefused(record) || HasSucceeded(record, {}));
  }
}

// Indices and counts come from an estimator of a user's own: none may be used before it is checked.
TEST(Score, AnAccountThatCannotBeIsNoCrash) {
  for (const std::vector<int>& inliers : {std::vector<int>{0, 6}, {-1}, {2147483647}, {1, 3, 1}}) {
    MotionEstimate estimate = HandMadeEstimate(0.0, 0.0);
    estimate.inliers = inliers;
    const TrialRecord record = Score(estimate, HandMadeData(), 0.0);
    EXPECT_EQ(record.status, MotionStatus::kInvalidMotion);
    EXPECT_EQ(record.num_inliers, 0);
    EXPECT_EQ(record.nees, std::numeric_limits<double>::infinity());
  }
}

TEST(Score, UnknownTruth) {
  TrialData data = HandMadeData();
  data.truth = {};
  const TrialRecord record = Score(HandMadeEstimate(40.0, 80.0), data, 0.0);
  for (const double unknown : {record.rotation_error_deg, record.direction_error_deg, record.nees,
                               record.inlier_precision, record.inlier_recall}) {
    EXPECT_TRUE(std::isnan(unknown));
  }
  EXPECT_EQ(record.num_inliers, 3);
  EXPECT_FALSE(HasFailed(record, {}));
  EXPECT_FALSE(HasSucceeded(record, {}));
}

TEST(Score, UnknownDirection) {
  TrialData data = HandMadeData();
  data.truth.is_direction_known = false;
  const TrialRecord good = Score(HandMadeEstimate(2.0, 80.0), data, 0.0);
  EXPECT_NEAR(good.rotation_error_deg, 2.0, 1e-9);
  EXPECT_TRUE(std::isnan(good.direction_error_deg));
  EXPECT_TRUE(std::isnan(good.nees));
  EXPECT_TRUE(HasSucceeded(good, {}));
  EXPECT_TRUE(HasFailed(Score(HandMadeEstimate(4.0, 0.0), data, 0.0), {}));
}

TEST(Score, PrecisionAndRecallAtTheirEnds) {
  MotionEstimate estimate = HandMadeEstimate(0.0, 0.0);
  estimate.inliers = {};
  TrialRecord record = Score(estimate, HandMadeData(), 0.0);
  EXPECT_TRUE(std::isnan(record.inlier_precision));  // 0 of 0
  EXPECT_EQ(record.inlier_recall, 0.0);
  estimate.inliers = {0, 1, 2, 3};
  record = Score(estimate, HandMadeData(), 0.0);
  EXPECT_EQ(record.inlier_precision, 1.0);
  EXPECT_EQ(record.inlier_recall, 1.0);
  TrialData data = HandMadeData();
  data.truth.is_inlier_true.assign(6, false);
  record = Score(estimate, data, 0.0);
  EXPECT_EQ(record.inlier_precision, 0.0);
  EXPECT_TRUE(std::isnan(record.inlier_recall));  // 0 of 0
}

TEST(Score, ACovarianceThatIsNoneIsNotCalibrated) {
  MotionEstimate estimate = HandMadeEstimate(1.0, 1.0);
  estimate.pose_cov = Matrix5d::Zero();  // claims to know the motion exactly
  EXPECT_EQ(Score(estimate, HandMadeData(), 0.0).nees, std::numeric_limits<double>::infinity());
}

TEST(Score, CopiesTheEstimatorsOwnAccount) {
  MotionEstimate estimate = HandMadeEstimate(1.0, 1.0);
  estimate.num_support = 5;
  estimate.mean_entropy = -4.5;
  estimate.z_statistic = -2.5;
  estimate.num_consistent_before = 5;
  estimate.num_consistent_after = 2;
  estimate.failed_by_kappa = true;
  estimate.counts = {20, 1, 2, 3, 4, 10};
  const TrialRecord record = Score(estimate, HandMadeData(), 0.0);
  EXPECT_EQ(record.num_support, 5);
  EXPECT_EQ(record.mean_entropy, -4.5);
  EXPECT_EQ(record.z_statistic, -2.5);
  EXPECT_EQ(record.num_consistent_before, 5);
  EXPECT_EQ(record.num_consistent_after, 2);
  EXPECT_TRUE(record.failed_by_kappa);
  EXPECT_EQ(record.counts.num_hypotheses, 20);
  EXPECT_EQ(record.counts.num_candidates, 10);
  estimate.num_support = 0;  // nothing was selected: its entropy is no number
  EXPECT_TRUE(std::isnan(Score(estimate, HandMadeData(), 0.0).mean_entropy));
}

}  // namespace
}  // namespace rcme
