// The layout that a simulated twin is fitted to, of templates whose points are known.
#include "experiments/real/truth_free/twin_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "estimator/estimator_registry.h"
#include "experiments/real/truth_free/twin_source.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

// 101 points on rays over the image at the depths 5, 5.1, ..., 15 baselines seen by a camera that turns by
// `turn_deg` about y and moves sideways, and wrong matches as given.
AnsweredTrial MakeTemplate(double turn_deg, const std::vector<Correspondence>& wrong) {
  AnsweredTrial one;
  one.estimate.status = MotionStatus::kNoCandidate;  // nothing says how large the noise is
  TrialData exact;
  exact.problem.camera1 = TestCamera1();
  exact.problem.camera2 = TestCamera2();
  const RelativePose pose{RotationFromVector({0.0, turn_deg * std::numbers::pi / 180.0, 0.0}),
                          Eigen::Vector3d(-1.0, 0.0, 0.0)};
  for (int i = 0; i <= 100; ++i) {
    const double depth = 5.0 + 0.1 * i;
    const Eigen::Vector3d point(depth * 0.03 * (i % 11 - 5), depth * 0.05 * (i % 7 - 3), depth);
    exact.problem.matches.push_back(ProjectToBoth(point, pose, exact.problem.camera1, exact.problem.camera2));
    exact.truth.is_inlier_true.push_back(true);
  }
  for (const Correspondence& match : wrong) {
    exact.problem.matches.push_back(match);
    exact.truth.is_inlier_true.push_back(false);
  }
  exact.truth.cam2_from_cam1_true = pose;
  one.pair = exact;
  one.pair.problem.sigma_px = 0.7;
  one.exact = exact;
  return one;
}

TwinFit FitOfTemplates(std::vector<AnsweredTrial> pairs) {
  return FitTwin({"made", std::move(pairs)}, *MakeEstimator("standard"), 1);
}

TEST(FitTwin, MeasuresTheLayoutOfATemplate) {
  const TwinFit fit = FitOfTemplates({MakeTemplate(2.0, {})});
  EXPECT_EQ(fit.num_templates, 1);
  EXPECT_EQ(fit.num_matches, 101);
  EXPECT_EQ(fit.camera1.fx, TestCamera1().fx);
  EXPECT_EQ(fit.camera2.fx, TestCamera2().fx);
  EXPECT_NEAR(fit.rotation_deg, 2.0, 1e-9);
  EXPECT_NEAR(fit.forwardness, 0.0, 1e-12);
  // Quantiles of the depths, to what rays of unit z and depths along z differ by: nothing.
  EXPECT_NEAR(fit.nearest, 5.5, 0.2);
  EXPECT_NEAR(fit.farthest, 14.5, 0.2);
  // The parallax of the middle: about 1 / 10 rad, a little less beside the axis.
  EXPECT_NEAR(fit.parallax_deg, 0.1 * 180.0 / std::numbers::pi, 0.5);
  EXPECT_EQ(fit.wrong_share, 0.0);
  EXPECT_EQ(fit.noise.noise_px, 0.7);  // no answer: what is assumed
}

// Of three wrong matches two are 20 px apart and move alike, to 5 px; the third is near them and does not.
TEST(FitTwin, CountsWrongMatchesThatMoveAlike) {
  const std::vector<Correspondence> wrong = {
      {{100.0, 100.0}, {300.0, 200.0}}, {{120.0, 100.0}, {325.0, 200.0}}, {{110.0, 110.0}, {500.0, 100.0}}};
  EXPECT_NEAR(FitOfTemplates({MakeTemplate(2.0, wrong)}).wrong_agreeing_share, 2.0 / 3.0, 1e-12);
  const std::vector<Correspondence> apart = {{{100.0, 100.0}, {300.0, 200.0}},
                                             {{200.0, 100.0}, {400.0, 200.0}}};
  EXPECT_EQ(FitOfTemplates({MakeTemplate(2.0, apart)}).wrong_agreeing_share, 0.0);
}

// The wrong share is a mean over templates, of 3 in 104 and of none in 101.
TEST(FitTwin, AveragesTheWrongShare) {
  const std::vector<Correspondence> wrong(3, {{100.0, 100.0}, {300.0, 200.0}});
  const TwinFit fit =
      FitOfTemplates({MakeTemplate(2.0, wrong), MakeTemplate(4.0, {}), MakeTemplate(9.0, {})});
  EXPECT_NEAR(fit.wrong_share, 3.0 / 104.0 / 3.0, 1e-12);
  EXPECT_NEAR(fit.rotation_deg, 4.0, 1e-9);
}

}  // namespace
}  // namespace rcme
