// Twins of pairs: what is drawn anew, what is fitted, and what is said where simulation explains a set and
// where not.
#include "experiments/real/truth_free/twin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "estimator/estimator_registry.h"
#include "estimator/geometry/sampson.h"
#include "experiments/core/table/render_table.h"
#include "experiments/data/make_data.h"
#include "experiments/data/match_folder.h"
#include "experiments/real/truth_free/twin_output.h"
#include "experiments/real/truth_free/twin_settings.h"
#include "experiments/study/study_file.h"
#include "stats/median_ratio.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/temp_folder.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// The exact matches of a scene, 40 of 200 of them anywhere; every place is there twice where asked.
TrialData ExactPair(bool is_twice = false) {
  const Scene scene = TwoCameraScene(200, 1);
  TrialData exact;
  exact.origin = "exact";
  exact.problem = {ObserveTwoCameraScene(scene, 1e-9, 0.2, 1).matches, scene.camera1, scene.camera2, 0.5};
  if (is_twice) {
    const std::vector<Correspondence> once = exact.problem.matches;
    exact.problem.matches.insert(exact.problem.matches.end(), once.begin(), once.end());
  }
  exact.truth.cam2_from_cam1_true = scene.cam2_from_cam1_true;
  Redraw::Label(&exact);
  return exact;
}

StreamName Named(std::uint32_t trial) { return {1, 7, trial, 0}; }

// 160 right matches of four coordinates: the mean square of 640 normal numbers, z-test at 1e-4.
TEST(Redraw, AddsNoiseToTheRightMatchesAndDealsOutTheWrongOnes) {
  const TrialData exact = ExactPair();
  const std::vector<bool>& is_right = exact.truth.is_inlier_true;
  EXPECT_EQ(std::count(is_right.begin(), is_right.end(), true), 160);
  RedrawSettings settings;
  settings.noise_px = 0.3;
  const Redraw redraw(settings);
  const TrialData drawn = redraw.Draw(exact, Named(0));
  double sum = 0.0;
  std::vector<double> before, after;
  for (size_t i = 0; i < is_right.size(); ++i) {
    const Correspondence &was = exact.problem.matches[i], &is = drawn.problem.matches[i];
    if (is_right[i]) {
      sum += (is.x1_px - was.x1_px).squaredNorm() + (is.x2_px - was.x2_px).squaredNorm();
    } else {
      EXPECT_EQ(is.x1_px, was.x1_px);
      before.push_back(was.x2_px.x());
      after.push_back(is.x2_px.x());
    }
  }
  EXPECT_NEAR(sum / 640.0 / 0.09, 1.0, 3.89 * std::sqrt(2.0 / 640.0));
  EXPECT_NE(before, after);
  EXPECT_THAT(after, testing::UnorderedElementsAreArray(before));
  EXPECT_EQ(redraw.Draw(exact, Named(0)).problem.matches[0].x1_px, drawn.problem.matches[0].x1_px);
  EXPECT_NE(redraw.Draw(exact, Named(1)).problem.matches[0].x1_px, drawn.problem.matches[0].x1_px);
  settings.wrong = WrongMatches::kKept;
  const TrialData kept = Redraw(settings).Draw(exact, Named(0));
  for (size_t i = 0; i < is_right.size(); ++i) {
    if (!is_right[i]) {
      EXPECT_EQ(kept.problem.matches[i].x2_px, exact.problem.matches[i].x2_px);
    }
  }
}

// Two matches at one place: their errors have the near and the far share in common, each with the variance of
// the whole. 640 products of correlated normals: standard error of a correlation r at most sqrt((1 + r^2) /
// 640), four of them.
TEST(Redraw, SharesNoiseBetweenNeighbours) {
  const TrialData exact = ExactPair(true);
  RedrawSettings settings;
  settings.noise_px = 0.5;
  settings.near_share = 0.5;
  settings.far_share = 0.2;
  const TrialData drawn = Redraw(settings).Draw(exact, Named(0));
  double products = 0.0, squares = 0.0;
  for (size_t i = 0; i < 200; ++i) {
    if (!exact.truth.is_inlier_true[i]) continue;
    const auto error_of = [&](size_t k) {
      const Correspondence &was = exact.problem.matches[k], &is = drawn.problem.matches[k];
      Eigen::Vector4d error;
      error << is.x1_px - was.x1_px, is.x2_px - was.x2_px;
      return error;
    };
    products += error_of(i).dot(error_of(i + 200));
    squares += 0.5 * (error_of(i).squaredNorm() + error_of(i + 200).squaredNorm());
  }
  // Neighbours in one cell of the mosaics share more than one value: the sum of squares is of fewer numbers.
  EXPECT_NEAR(squares / 640.0 / 0.25, 1.0, 0.5);
  EXPECT_NEAR(products / squares, 0.7, 0.1);
}

// Half of the sum of a match's four squares over noise_px^2, in the median: of normal noise chi-square(4) /
// 4, 0.839; of Student's t with 1.5 degrees of freedom the errors are large in few matches, and the others
// have little: below a fifth of it. Of 160 the median has a standard error below 0.06; four of them.
double MedianSquare(double dof, double within_px = 0.0) {
  const TrialData exact = ExactPair();
  RedrawSettings settings;
  settings.noise_px = 0.5;
  settings.student_dof = dof;
  settings.within_px = within_px;
  const TrialData drawn = Redraw(settings).Draw(exact, Named(0));
  std::vector<double> sums;
  for (size_t i = 0; i < exact.problem.matches.size(); ++i) {
    if (!exact.truth.is_inlier_true[i]) continue;
    const Correspondence &was = exact.problem.matches[i], &is = drawn.problem.matches[i];
    sums.push_back((is.x1_px - was.x1_px).squaredNorm() + (is.x2_px - was.x2_px).squaredNorm());
  }
  return ComputeMedian(sums);
}
TEST(Redraw, StudentsNoiseIsLargeForAllOfAMatch) {
  EXPECT_NEAR(MedianSquare(0.0), 0.839, 0.24);
  EXPECT_LT(MedianSquare(1.5), 0.2);
}

// What was found near stays near and what was wrong stays wrong, at the pair's own level.
TEST(Redraw, KeepsRightMatchesNearAndWrongOnesFar) {
  const TrialData exact = ExactPair();
  RedrawSettings settings;
  settings.noise_px = 0.5;
  settings.student_dof = 1.5;
  settings.within_px = 0.6;
  for (const double level : {1.0, 3.0}) {
    const TrialData drawn = Redraw(settings).Draw(exact, Named(0), level);
    const Eigen::Matrix3d F = ComputeFundamental(exact.problem, *exact.truth.cam2_from_cam1_true);
    double greatest = 0.0;
    for (size_t i = 0; i < exact.problem.matches.size(); ++i) {
      const double distance = std::sqrt(SquaredSampsonDistance(F, drawn.problem.matches[i]));
      EXPECT_EQ(distance <= level * settings.within_px, exact.truth.is_inlier_true[i]) << i;
      if (exact.truth.is_inlier_true[i]) greatest = std::max(greatest, distance);
    }
    EXPECT_GT(greatest, 0.8 * level * settings.within_px);
  }
}

TEST(Redraw, SaysWhatIsWrong) {
  RedrawSettings settings;
  settings.noise_px = 0.3;
  settings.near_share = 0.7;
  settings.far_share = 0.4;
  EXPECT_TRUE(ThrowsInputError([&] { const Redraw made(settings); }, {"redraw_near_share: 0.7", "0.4"}));
  TrialData unknown = ExactPair();
  unknown.truth.cam2_from_cam1_true.reset();
  EXPECT_TRUE(ThrowsInputError([&] { Redraw::Label(&unknown); }, {"exact states no true motion"}));
}

// What is said of the noise, or the median distance over that of a normal number, of matches alike.
TEST(EstimateNoise, IsTheMedianOfTheResiduals) {
  RelativePose pose;
  MotionProblem problem = TwoCameraProblem(5, 1e-9, 0.0, 1, &pose);
  const Eigen::Matrix3d F = ComputeFundamental(problem, pose);
  MotionEstimate estimate;
  estimate.cam2_from_cam1 = pose;
  const double off_px[] = {0.1, -0.2, 0.6, 0.4, -0.5};
  problem.noise_scale = {1.0, 1.0, 2.0, 0.5, 1.0};  // 0.1, 0.2, 0.3, 0.8, 0.5
  for (size_t i = 0; i < 5; ++i) {
    Correspondence& match = problem.matches[i];
    const Eigen::Vector4d u = EvaluateConstraint(F, match).gradient.normalized();
    match.x1_px += off_px[i] * u.head<2>();
    match.x2_px += off_px[i] * u.tail<2>();
    estimate.inliers.push_back(static_cast<int>(i));
  }
  EXPECT_NEAR(EstimateNoise(problem, estimate), 0.3 / 0.6744897501960817, 0.005);
  estimate.sigma_estimated_px = 0.25;
  EXPECT_EQ(EstimateNoise(problem, estimate), 0.25);
}

// To second order of the distance: of one pixel a few millionths are left, and the way there is the shortest.
TEST(Snapped, IsTheNearestExactMatch) {
  RelativePose pose;
  MotionProblem problem = TwoCameraProblem(30, 0.7, 0.0, 1, &pose);
  const Eigen::Matrix3d F = ComputeFundamental(problem, pose);
  for (const Correspondence& match : problem.matches) {
    const Correspondence snapped = Snapped(F, match);
    EXPECT_LT(std::sqrt(SquaredSampsonDistance(F, snapped)), 1e-5);
    const double moved_px =
        std::hypot((snapped.x1_px - match.x1_px).norm(), (snapped.x2_px - match.x2_px).norm());
    EXPECT_NEAR(moved_px, std::sqrt(SquaredSampsonDistance(F, match)), 0.02);
  }
}

// Matches that are said to be noisier get as much more noise: of 300 each of scale 1/2 and 3 the mean square
// of the distance, over that of the noise, is 1 (z-test at 1e-4).
TEST(MakeTwin, DrawsNoiseOfTheMatchsScale) {
  RelativePose pose;
  NamedPair pair{"pair", "", "", TwoCameraProblem(600, 0.5, 0.0, 1, &pose)};
  MotionEstimate estimate;
  estimate.status = MotionStatus::kOk;
  estimate.cam2_from_cam1 = pose;
  estimate.sigma_estimated_px = 0.2;
  for (int i = 0; i < 600; ++i) {
    pair.problem.noise_scale.push_back(i < 300 ? 0.5 : 3.0);
    estimate.inliers.push_back(i);
  }
  const NamedPair twin = MakeTwin(pair, estimate, 1, 1);
  const Eigen::Matrix3d F = ComputeFundamental(pair.problem, pose);
  double sums[2] = {0.0, 0.0};
  for (size_t i = 0; i < 600; ++i) {
    const double sd_px = 0.2 * pair.problem.noise_scale[i];
    sums[i / 300] += SquaredSampsonDistance(F, twin.problem.matches[i]) / (sd_px * sd_px) / 300.0;
  }
  for (const double mean : sums) EXPECT_NEAR(mean, 1.0, 3.89 * std::sqrt(2.0 / 300.0));
}

// Of 2,000 twins, in image 1: half the squared difference of the errors of two key points 20 px apart, over
// sigma^2, is 1 - share exp(-20 px / reach), and an error has the variance sigma^2 (z-tests at 1e-4 by the
// sample's own scatter). A second pair of the same image has its field too.
TEST(MakeTwin, DrawsTheFieldOfItsImages) {
  RelativePose pose;
  NamedPair pair{"pair", "a", "b", TwoCameraProblem(10, 0.5, 0.0, 1, &pose)};
  pair.problem.matches[1] = pair.problem.matches[0];
  pair.problem.matches[1].x1_px.x() += 20.0;
  pair.problem.matches[1].x2_px.x() += 20.0;
  MotionEstimate estimate;
  estimate.status = MotionStatus::kOk;
  estimate.cam2_from_cam1 = pose;
  estimate.sigma_estimated_px = 0.2;
  estimate.inliers = {0, 1};
  const Eigen::Matrix3d F = ComputeFundamental(pair.problem, pose);
  const auto error = [&](const NamedPair& twin, size_t i) {
    return Eigen::Vector2d((twin.problem.matches[i].x1_px - Snapped(F, pair.problem.matches[i]).x1_px) / 0.2);
  };
  const TwinField field = {0.6, 40.0};
  const double expected = 1.0 - 0.6 * std::exp(-20.0 / 40.0);
  Eigen::Array2d sums = Eigen::Array2d::Zero(), squares = Eigen::Array2d::Zero();
  constexpr int kTwins = 2000;
  for (std::uint32_t twin = 1; twin <= kTwins; ++twin) {
    const NamedPair made = MakeTwin(pair, estimate, 1, twin, field);
    const Eigen::Vector2d e0 = error(made, 0), e1 = error(made, 1);
    const Eigen::Array2d values(0.5 * e0.squaredNorm(), 0.25 * (e0 - e1).squaredNorm());
    sums += values;
    squares += values.square();
  }
  const Eigen::Array2d mean = sums / kTwins, se = ((squares / kTwins - mean.square()) / kTwins).sqrt();
  EXPECT_LT(std::abs(mean(0) - 1.0), 3.89 * se(0)) << mean(0);
  EXPECT_LT(std::abs(mean(1) - expected), 3.89 * se(1)) << mean(1) << " " << expected;
  NamedPair second = pair;
  second.name = "second";
  const NamedPair made = MakeTwin(pair, estimate, 1, 1, field),
                  again = MakeTwin(second, estimate, 1, 1, field);
  EXPECT_EQ(made.problem.matches[0].x1_px, again.problem.matches[0].x1_px);
  second.image1 = "c";
  EXPECT_NE(MakeTwin(second, estimate, 1, 1, field).problem.matches[0].x1_px, made.problem.matches[0].x1_px);
}

// Pairs of a simulated study as a source of twins.
TwinSource MakeTwinSource(const Settings& more, int num_pairs, const MotionEstimator& estimator) {
  Settings data = {{"scene", "image_clusters"}, {"num_matches", "300"},  {"outlier_ratio", "0.25"},
                   {"sigma_px", "0.3"},         {"parallax_deg", "4"},   {"motion", "sideways"},
                   {"assumed_sigma_px", "0.5"}, {"severity", "skipped"}, {"clustered_share", "0"}};
  data.insert(data.end(), more.begin(), more.end());
  const auto simulated = MakeSimulatedData(data);
  class Pairs : public DataSource {
   public:
    Pairs(std::shared_ptr<const SimulatedData> from, int n) : from_(std::move(from)), n_(n) {}
    int NumTrials(int) const override { return n_; }
    TrialData Make(const StreamName& name) const override {
      TrialData pair = from_->Make(name);
      pair.origin = "pair_" + std::to_string(name.trial) + ".csv";
      return pair;
    }

   private:
    std::shared_ptr<const SimulatedData> from_;
    int n_;
  };
  return AnswerScene("made", Pairs(simulated, num_pairs), {}, estimator, 1);
}

// Twelve pairs of 225 right matches: sigma is known to 2 %, and to what the estimator's own scale is worth.
TEST(FitTwin, FindsTheNumbersOfASimulation) {
  const auto estimator = MakeEstimator("rcme_calibrated");
  const TwinFit fit = FitTwin(MakeTwinSource({}, 12, *estimator), *estimator, 1);
  EXPECT_EQ(fit.num_templates, 12);
  EXPECT_NEAR(fit.noise.noise_px, 0.3, 0.03);
  EXPECT_TRUE(fit.noise.student_dof == 0.0 || fit.noise.student_dof >= 6.0) << fit.noise.student_dof;
  EXPECT_LT(fit.noise.far_share, 0.1);
  EXPECT_EQ(fit.num_matches, 300);
  EXPECT_NEAR(fit.wrong_share, 0.25, 0.02);
  EXPECT_LT(fit.wrong_agreeing_share, 0.1);
  EXPECT_NEAR(fit.parallax_deg, 4.0, 0.5);
  EXPECT_LT(fit.forwardness, 0.2);
  EXPECT_NEAR(fit.clark_evans, 1.0, 0.1);
  const Settings data = SimulatedTwinData(fit, FitClusteredShare(fit), 0.5);
  EXPECT_THAT(data, testing::Contains(Settings::value_type("scene", "image_clusters")));
  EXPECT_NO_THROW(MakeSimulatedData(data));
}

const TwinComparison& Found(const TwinReport& report, const std::string& quantity, const std::string& twin) {
  for (const TwinComparison& c : report.comparisons) {
    if (c.quantity == quantity && c.twin == twin) return c;
  }
  throw std::logic_error(quantity);
}

// Tails as long as those of real key points are found again, by the size of the noise too. The estimator's
// sigma is that of the precise matches: with 1.5 degrees of freedom a fraction of the root mean square.
TEST(TwinReport, ResemblesTailsOfRealLength) {
  const auto estimator = MakeEstimator("rcme_calibrated");
  const TwinSource source = MakeTwinSource(
      {{"noise", "correlated"}, {"noise_correlation", "0"}, {"noise_student_dof", "1.5"}, {"sigma_px", "1"}},
      12, *estimator);
  const TwinReport report = MakeTwinReport(source, *estimator, "pairs", 0.5, 1, 2);
  EXPECT_THAT(report.fit.noise.student_dof, testing::AllOf(testing::Ge(1.0), testing::Le(2.5)));
  EXPECT_THAT(report.fit.simulated_noise.student_dof, testing::AllOf(testing::Ge(1.0), testing::Le(2.5)));
  EXPECT_GT(Found(report, "tail_share", "semi_real").observed, 0.07);
  for (const char* twin : {"semi_real", "simulated"}) {
    EXPECT_TRUE(Found(report, "tail_share", twin).is_fitted);
    EXPECT_FALSE(Found(report, "inlier_test", twin).is_fitted);
    EXPECT_GE(report.NumWithin(twin, false), report.NumCompared(twin, false) - 1)
        << MakeTwinsResult({report}).text;
    EXPECT_GE(report.NumWithin(twin, true), report.NumCompared(twin, true) - 1)
        << MakeTwinsResult({report}).text;
  }
}

// Of a simulated set simulation explains all, but for one quantity of thirteen at most: with probability 0.95
// all of them, one seed. Points that are found twice are among what a twin can show; a distortion is not, and
// halves say so if the covariance is not widened for it.
TEST(TwinReport, SaysWhatSimulationExplains) {
  const auto estimator = MakeEstimator("rcme_calibrated");
  const TwinReport own = MakeTwinReport(MakeTwinSource({}, 12, *estimator), *estimator, "pairs", 0.5, 1, 2);
  EXPECT_EQ(own.why_not_simulated, "");
  EXPECT_GE(own.NumCompared("semi_real", false), 7);
  EXPECT_GE(own.NumCompared("semi_real", true), 4);
  // The fit of a simulated twin has the noise of its own draws, some per cent of sigma.
  EXPECT_GE(own.NumWithin("semi_real", false), own.NumCompared("semi_real", false) - 1)
      << MakeTwinsResult({own}).text;
  EXPECT_GE(own.NumWithin("simulated", false), own.NumCompared("simulated", false) - 2)
      << MakeTwinsResult({own}).text;
  for (const char* twin : {"semi_real", "simulated"})
    EXPECT_GE(own.NumWithin(twin, true), own.NumCompared(twin, true) - 1) << MakeTwinsResult({own}).text;

  const auto unchecked = MakeEstimator("rcme_calibrated", {{"leave_out", "model_check"}});
  const TwinReport bent = MakeTwinReport(MakeTwinSource({{"distortion_k1", "0.2"}}, 12, *unchecked),
                                         *unchecked, "pairs", 0.5, 1, 2);
  EXPECT_FALSE(Found(bent, "spatial_halves", "semi_real").IsWithin()) << MakeTwinsResult({bent}).text;
  EXPECT_THAT(MakeTwinsResult({bent}).text, testing::HasSubstr("not explained: left/right"));
  EXPECT_THAT(RenderCsv(MakeTwinsResult({bent}).rows),
              testing::HasSubstr("made,12,semi_real,spatial_halves,rate,no,"));
}

TEST(FitTwin, WithoutAPairToResembleSaysSo) {
  const auto estimator = MakeEstimator("rcme_calibrated");
  TwinSource source = MakeTwinSource({}, 2, *estimator);
  for (AnsweredTrial& one : source.pairs) one.exact.reset();
  EXPECT_TRUE(
      ThrowsInputError([&] { FitTwin(source, *estimator, 1); }, {"scene made", "nothing to resemble"}));
}

}  // namespace
}  // namespace rcme
