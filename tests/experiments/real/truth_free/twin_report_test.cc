// What is compared between pairs and twins, of answers whose means and scatter are known by hand.
#include "experiments/real/truth_free/twin_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

const RelativePose kToTheSide = {Eigen::Matrix3d::Identity(), Eigen::Vector3d(-1.0, 0.0, 0.0)};

MotionEstimate AnswerToTheSide(size_t num_matches, double rotation_sd_rad, double failure_probability) {
  MotionEstimate estimate;
  estimate.status = MotionStatus::kOk;
  estimate.cam2_from_cam1 = kToTheSide;
  estimate.pose_cov = 1e-6 * Matrix5d::Identity();
  estimate.pose_cov.topLeftCorner<3, 3>() *= 1e6 * rotation_sd_rad * rotation_sd_rad / 3.0;
  estimate.sigma_estimated_px = 0.5;
  estimate.failure_probability = failure_probability;
  for (int i = 0; i < static_cast<int>(num_matches); ++i) estimate.inliers.push_back(i);
  return estimate;
}

// States a probability of failure in proportion to the number of matches, by which it tells pairs apart, and
// 3 mrad of the rotation; refuses problems of `refused_size` matches.
class AnswersBySize : public MotionEstimator {
 public:
  explicit AnswersBySize(size_t refused_size = 0, double failure_per_match = 1e-3)
      : refused_size_(refused_size), failure_per_match_(failure_per_match) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream&) const override {
    const size_t n = problem.matches.size();
    MotionEstimate estimate = AnswerToTheSide(n, 3e-3, static_cast<double>(n) * failure_per_match_);
    if (n == refused_size_) estimate.status = MotionStatus::kNoCandidate;
    return estimate;
  }

 private:
  size_t refused_size_;
  double failure_per_match_;
};

// A plane ten baselines deep, every point of it found twice, 0.5 px apart, 0.6 px off the epipolar lines.
AnsweredTrial PairOnAPlane(int number, int num_matches, const MotionEstimate& estimate) {
  AnsweredTrial one;
  one.pair.origin = "pair_" + std::to_string(number);
  MotionProblem& problem = one.pair.problem;
  problem.camera1 = problem.camera2 = {60.0, 60.0, 29.5, 24.5, 60, 50};
  RandomStream rng({.seed = 1, .trial = static_cast<std::uint32_t>(number), .purpose = 79});
  for (int i = 0; i < num_matches; i += 2) {
    const double x = rng.Uniform(7.0, 55.0), y = rng.Uniform(1.0, 48.0);
    problem.matches.push_back({{x, y}, {x - 6.0, y}});
    problem.matches.push_back({{x + 0.5, y}, {x - 5.5, y}});
  }
  one.exact = one.pair;
  one.exact->truth.cam2_from_cam1_true = kToTheSide;
  one.exact->truth.is_inlier_true.assign(problem.matches.size(), true);
  for (size_t i = 0; i < problem.matches.size(); ++i)
    problem.matches[i].x2_px.y() += i % 2 == 0 ? 0.85 : -0.85;
  one.estimate = estimate;
  return one;
}

// Two pairs of image a and two of image d. The answers to the pairs exceed those to their twins by 0.3, 0.3,
// 0.1 and 0.1 in the probability of failure (0.54, 0.54, 0.4, 0.4), and their rotations are known to 1, 1, 4
// and 4 mrad.
TwinSource FourPairs() {
  TwinSource source{"made", {}};
  const char* names[][2] = {{"a", "b"}, {"a", "c"}, {"d", "e"}, {"d", "f"}};
  for (int i = 0; i < 4; ++i) {
    const bool is_first = i < 2;
    const int n = is_first ? 240 : 300;
    const MotionEstimate estimate =
        AnswerToTheSide(static_cast<size_t>(n), is_first ? 1e-3 : 4e-3, is_first ? 0.54 : 0.4);
    source.pairs.push_back(PairOnAPlane(i, n, estimate));
    source.pairs.back().image1 = names[i][0];
    source.pairs.back().image2 = names[i][1];
  }
  return source;
}

// No scene is simulated with an assumed noise of zero.
TwinReport SemiRealReport(const TwinSource& source, const AnswersBySize& estimator) {
  return MakeTwinReport(source, estimator, "pairs", 0.0, 1, 1);
}

const TwinComparison* FindComparison(const TwinReport& report, const std::string& quantity,
                                     const std::string& twin) {
  for (const TwinComparison& c : report.comparisons) {
    if (c.quantity == quantity && c.twin == twin) return &c;
  }
  return nullptr;
}

void ExpectComparison(const TwinReport& report, const std::string& quantity, const std::string& twin,
                      double predicted, double observed, const Interval& joint, std::int64_t n) {
  const TwinComparison* c = FindComparison(report, quantity, twin);
  ASSERT_NE(c, nullptr) << quantity << ", " << twin;
  EXPECT_EQ(c->n, n);
  EXPECT_NEAR(c->predicted, predicted, 1e-9) << quantity << ", " << twin;
  EXPECT_NEAR(c->observed, observed, 1e-9) << quantity << ", " << twin;
  EXPECT_NEAR(c->joint.lower, joint.lower, 1e-9) << quantity << ", " << twin;
  EXPECT_NEAR(c->joint.upper, joint.upper, 1e-9) << quantity << ", " << twin;
}

// Twelve quantities are compared (nobody knows the motions: no failure), of each twin, so that each interval
// has the confidence 1 - 0.05 / 12. Deviations u, u, -u, -u of pairs with the images ab, ac, de, df, six in
// all: squared sums 4 u^2 of a and d, u^2 of the others, less u^2 of each pair, 8 u^2, times 6 / 5 over 4^2:
// the standard error is 0.6^0.5 u, with t of five degrees of freedom. Means of semi-real twins are compared
// pair by pair, where u = 0.1; a simulated twin is one of all, with the median of 270 matches, and u = 0.07.
TEST(MakeTwinReport, ComparesMeans) {
  const TwinReport report = MakeTwinReport(FourPairs(), AnswersBySize(), "pairs", 0.5, 1, 2);
  EXPECT_EQ(report.why_not_simulated, "");
  EXPECT_EQ(report.scene, "made");
  EXPECT_EQ(report.num_pairs, 4);
  ASSERT_EQ(report.comparisons.size(), 24u);
  const double half = std::sqrt(0.6) * StudentQuantile(5, 1.0 - 0.025 / 12.0);
  const auto around = [&](double x, double u) { return Interval{x - half * u, x + half * u}; };
  ExpectComparison(report, "stated_failure", "semi_real", 0.27, 0.47, around(0.47, 0.1), 4);
  ExpectComparison(report, "stated_failure", "simulated", 0.27, 0.47, around(0.47, 0.07), 4);
  // Standard deviations: geometric means, of 1 and 4 mrad 2, intervals symmetric in the logarithm.
  const double mean_deg = 2e-3 * kDegPerRad;
  const Interval joint = {mean_deg * std::exp(-half * std::log(2.0)),
                          mean_deg * std::exp(half * std::log(2.0))};
  for (const char* twin : {"semi_real", "simulated"}) {
    ExpectComparison(report, "rotation_sd_deg", twin, 3e-3 * kDegPerRad, mean_deg, joint, 4);
    const double direction_deg = std::sqrt(2.0) * 1e-3 * kDegPerRad;
    ExpectComparison(report, "direction_sd_deg", twin, direction_deg, direction_deg,
                     {direction_deg, direction_deg}, 4);
  }
}

// A simulated twin is not made to have points that are found twice; a semi-real one is.
TEST(MakeTwinReport, TellsWhatIsFitted) {
  const TwinReport report = MakeTwinReport(FourPairs(), AnswersBySize(), "pairs", 0.5, 1, 1);
  EXPECT_EQ(report.NumCompared("semi_real", true), 5);
  EXPECT_EQ(report.NumCompared("semi_real", false), 7);
  EXPECT_EQ(report.NumCompared("simulated", true), 4);
  EXPECT_EQ(report.NumCompared("simulated", false), 8);
  for (const char* twin : {"semi_real", "simulated"}) {
    const TwinComparison *near = FindComparison(report, "near_correlation", twin),
                         *far = FindComparison(report, "far_correlation", twin);
    ASSERT_TRUE(near && far) << twin;
    EXPECT_EQ(near->is_fitted, std::string(twin) == "semi_real");
    EXPECT_TRUE(far->is_fitted);
  }
}

// Without names every pair has two images of its own: no sums but the pairs' own. The variance is that of
// independent numbers, u^2 4 / 3 over 4, u = 0.1, with t of three degrees of freedom, as there are four
// pairs.
TEST(MakeTwinReport, ImagesWithoutANameAreSharedByNoPairs) {
  TwinSource source = FourPairs();
  for (AnsweredTrial& one : source.pairs) one.image1 = one.image2 = "";
  const double half = 0.1 / std::sqrt(3.0) * StudentQuantile(3, 1.0 - 0.025 / 12.0);
  ExpectComparison(SemiRealReport(source, AnswersBySize()), "stated_failure", "semi_real", 0.27, 0.47,
                   {0.47 - half, 0.47 + half}, 4);
}

// The twins of the first two pairs are refused, none of the pairs: 0 of 4 against a half. Two pairs are too
// few for a mean, so that the rates alone are left: refusals and two kinds of halves. Of four pairs two share
// no image: the upper end is that of 0 of 2, 1 - (0.025 / 3)^(1 / 2).
TEST(MakeTwinReport, ComparesRates) {
  const TwinReport report = SemiRealReport(FourPairs(), AnswersBySize(240));
  EXPECT_EQ(report.comparisons.size(), 3u);
  ExpectComparison(report, "refusal", "semi_real", 0.5, 0.0, {0.0, 1.0 - std::sqrt(0.025 / 3.0)}, 4);
  const TwinComparison* halves = FindComparison(report, "spatial_halves", "semi_real");
  ASSERT_NE(halves, nullptr);
  EXPECT_EQ(halves->n, 8);
  EXPECT_EQ(halves->observed, 1.0);
  EXPECT_EQ(halves->predicted, 1.0);
  EXPECT_TRUE(halves->is_rate);
}

// The first pair is refused: its twins do not count in means, of which three pairs are left, 0.24, 0.3 and
// 0.3 predicted, exceeded by 0.3, 0.1 and 0.1.
TEST(MakeTwinReport, PairsWithoutAValueTakeNoPartInMeans) {
  TwinSource source = FourPairs();
  source.pairs[0].estimate.status = MotionStatus::kNoCandidate;
  const TwinReport report = SemiRealReport(source, AnswersBySize());
  const TwinComparison *refusal = FindComparison(report, "refusal", "semi_real"),
                       *stated = FindComparison(report, "stated_failure", "semi_real");
  ASSERT_TRUE(refusal && stated);
  EXPECT_EQ(refusal->observed, 0.25);
  EXPECT_EQ(refusal->predicted, 0.0);
  EXPECT_EQ(stated->n, 3);
  EXPECT_NEAR(stated->predicted, 0.28, 1e-9);
  EXPECT_NEAR(stated->observed, 0.28 + 0.5 / 3.0, 1e-9);
}

// The twins have no probability of failure: there is nothing to compare with what the pairs have.
TEST(MakeTwinReport, WhatTwinsDoNotStateIsNotCompared) {
  const TwinReport report =
      SemiRealReport(FourPairs(), AnswersBySize(0, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(report.comparisons.size(), 11u);
  EXPECT_EQ(FindComparison(report, "stated_failure", "semi_real"), nullptr);
}

TEST(MakeTwinReport, SaysWhyNothingIsSimulated) {
  const TwinReport report = SemiRealReport(FourPairs(), AnswersBySize());
  EXPECT_THAT(report.why_not_simulated, testing::HasSubstr("assumed_sigma_px"));
  EXPECT_TRUE(report.simulated.empty());
  EXPECT_EQ(report.comparisons.size(), 12u);
  EXPECT_EQ(report.NumCompared("simulated", false) + report.NumCompared("simulated", true), 0);
  EXPECT_THAT(report.semi_real, testing::Contains(Settings::value_type("folder", "pairs")));
}

// Both ends of an interval belong to it.
TEST(TwinReport, CountsWhatLiesWithin) {
  TwinReport report;
  const auto add = [&](const char* twin, bool is_fitted, double predicted) {
    report.comparisons.push_back({"sigma_px", twin, false, is_fitted, 9, 0.5, predicted, {0.25, 0.75}});
  };
  for (const double predicted : {0.2, 0.25, 0.5, 0.75, 0.8}) add("semi_real", false, predicted);
  for (const double predicted : {0.3, 1.0}) add("semi_real", true, predicted);
  add("simulated", true, 0.3);
  EXPECT_EQ(report.NumCompared("semi_real", false), 5);
  EXPECT_EQ(report.NumWithin("semi_real", false), 3);
  EXPECT_EQ(report.NumCompared("semi_real", true), 2);
  EXPECT_EQ(report.NumWithin("semi_real", true), 1);
  EXPECT_EQ(report.NumCompared("simulated", true), 1);
  EXPECT_EQ(report.NumWithin("simulated", true), 1);
  EXPECT_EQ(report.NumCompared("simulated", false), 0);
}

}  // namespace
}  // namespace rcme
