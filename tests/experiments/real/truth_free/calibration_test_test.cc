// The test of camera faults, and that of key-point sizes: derivatives against the simulator's own models,
// level and power by Monte Carlo.
#include "experiments/real/truth_free/calibration_test.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "estimator/estimator_registry.h"
#include "estimator/geometry/sampson.h"
#include "experiments/real/truth_free/calibration_score.h"
#include "experiments/real/truth_free/size_test.h"
#include "experiments/real/truth_free/twin.h"
#include "experiments/study/study_file.h"
#include "simulator/calibration_error.h"
#include "simulator/camera_defects.h"
#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// What two cameras show of a point, and what is assumed of them, where faults are as given.
struct Faulty {
  Camera camera1, camera2;
  Correspondence match;
};
Faulty With(const Eigen::VectorXd& faults, const Scene& scene, const Eigen::Vector3d& point) {
  CameraDefects defects;
  defects.distortion_k1 = faults(3);
  defects.rolling_shutter = faults(4);
  Faulty faulty{scene.camera1, scene.camera2, ImagedMatch(scene, defects, point)};
  const auto distort = [&](const Camera& camera, Eigen::Vector2d* x_px) {
    const Eigen::Vector3d ray = camera.Ray(*x_px);
    const double x = ray.x(), y = ray.y(), r2 = x * x + y * y;
    x_px->x() +=
        camera.fx * (faults(8) * r2 * r2 * x + faults(9) * (r2 + 2 * x * x) + faults(10) * 2 * x * y);
    x_px->y() +=
        camera.fy * (faults(8) * r2 * r2 * y + faults(9) * 2 * x * y + faults(10) * (r2 + 2 * y * y));
  };
  distort(scene.camera1, &faulty.match.x1_px);
  distort(scene.camera2, &faulty.match.x2_px);
  faulty.match.x2_px += faults.segment<2>(5);
  for (Camera* camera : {&faulty.camera1, &faulty.camera2}) {
    camera->fx *= 1.0 + faults(0);
    camera->fy *= (1.0 + faults(0)) * (1.0 + faults(7));
    camera->cx += faults(1);
    camera->cy += faults(2);
  }
  return faulty;
}

// D against the change of an exact match's residual with each fault of the simulator, one by one.
TEST(ResidualByFaults, IsTheDerivativeOfTheSimulatorsFaults) {
  const Scene scene = TwoCameraScene(12, 1);
  const RelativePose& pose = scene.cam2_from_cam1_true;
  const FaultVector steps{{1e-3, 0.1, 0.1, 1e-3, 1e-3, 0.1, 0.1, 1e-3, 1e-3, 1e-3, 1e-3}};
  for (const Eigen::Vector3d& point : scene.points_in_cam1) {
    const auto residual_at = [&](const Eigen::VectorXd& faults) {
      const auto [camera1, camera2, match] = With(faults, scene, point);
      const Eigen::Matrix3d F = FundamentalFromEssential(EssentialFromPose(pose), camera1, camera2);
      const EpipolarConstraint c = EvaluateConstraint(F, match);
      return Eigen::VectorXd::Constant(1, c.g / std::sqrt(c.squared_gradient())).eval();
    };
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(kNumCameraFaults);
    const Faulty exact = With(none, scene, point);
    const Eigen::Matrix3d F = FundamentalFromEssential(EssentialFromPose(pose), scene.camera1, scene.camera2);
    const Eigen::MatrixXd D = ResidualByFaults(F, scene.camera1, scene.camera2, pose, exact.match);
    for (int j = 0; j < kNumCameraFaults; ++j) {
      const auto along = [&](const Eigen::VectorXd& by) {
        return residual_at(by(0) * Eigen::VectorXd::Unit(kNumCameraFaults, j));
      };
      const Eigen::MatrixXd numeric =
          NumericJacobian(along, Eigen::VectorXd(Eigen::VectorXd::Zero(1)), steps(j));
      EXPECT_NEAR(D(0, j), numeric(0, 0), 1e-5 * std::abs(numeric(0, 0)) + 1e-6) << "fault " << j;
    }
  }
}

// With noise of 0.5 px the mean of D r is zero to four of its standard errors, each fault and each of six
// points, 20,000 draws: a false alarm of 0.002 in all. Without the terms in r that of the focal length would
// be -sigma^2, which is more than that.
TEST(ResidualByFaults, DoesNotGoWithTheNoise) {
  const Scene scene = TwoCameraScene(6, 2);
  const RelativePose& pose = scene.cam2_from_cam1_true;
  const Eigen::Matrix3d F = FundamentalFromEssential(EssentialFromPose(pose), scene.camera1, scene.camera2);
  RandomStream rng({.seed = 1, .purpose = 95});
  constexpr double kDraws = 20000.0, kSigmaPx = 0.5;
  double most_of_naive = 0.0;
  for (const Eigen::Vector3d& point : scene.points_in_cam1) {
    const Correspondence exact = ImagedMatch(scene, {}, point);
    FaultVector sum = FaultVector::Zero(), squares = sum;
    double naive = 0.0, naive_squares = 0.0;
    for (int i = 0; i < static_cast<int>(kDraws); ++i) {
      Correspondence match = exact;
      for (double* x : {&match.x1_px.x(), &match.x1_px.y(), &match.x2_px.x(), &match.x2_px.y()})
        *x += kSigmaPx * rng.Normal();
      const EpipolarConstraint c = EvaluateConstraint(F, match);
      const double norm = std::sqrt(c.squared_gradient()), r = c.g / norm;
      const FaultVector product =
          r * ResidualByFaults(F, scene.camera1, scene.camera2, pose, match).transpose();
      sum += product;
      squares += product.cwiseAbs2();
      const double plain =
          r * c.gradient.dot(ComputeShifts(scene.camera1, scene.camera2, pose, match).col(0)) / norm;
      naive += plain;
      naive_squares += plain * plain;
    }
    for (int j = 0; j < kNumCameraFaults; ++j)
      EXPECT_LT(std::abs(sum(j)), 4.0 * std::sqrt(squares(j))) << "fault " << j;
    most_of_naive = std::max(most_of_naive, std::abs(naive) / std::sqrt(naive_squares));
  }
  EXPECT_GT(most_of_naive, 4.0);
}

// Of pairs `first` to `last` of a set, without twins.
std::vector<PairAnswers> AnswerPairs(const PairSet& set, int first, int last) {
  const auto estimator = MakeEstimator("rcme_calibrated");
  std::vector<PairAnswers> answers;
  for (int i = first; i < last; ++i) {
    const NamedPair& pair = set.pairs[static_cast<size_t>(i)];
    RandomStream rng({.seed = 7, .trial = static_cast<std::uint32_t>(i), .purpose = 96});
    answers.push_back({{pair, estimator->Estimate(pair.problem, rng)}, {}});
  }
  return answers;
}

// Sets of `num_pairs` answered pairs of 400 matches, noise 0.2 px, 5 % of them wrong.
PairSet SimulatePairs(const Settings& data, int num_pairs) {
  Study study = ParseStudy(
      "data: {scene: uniform_volume, num_matches: 400, sigma_px: 0.2, outlier_ratio: 0.05}\n"
      "estimators: [{name: rcme_calibrated}]\nseed: 7\n",
      "study.yaml");
  study.trials = num_pairs;
  for (const auto& [key, value] : data) Override(&study, key, value);
  return PairSetsOfStudy(MakePlan(study)).front();
}
std::vector<CalibrationReport> MakeReports(const Settings& data, int num_sets, int num_pairs) {
  const PairSet pairs = SimulatePairs(data, num_sets * num_pairs);
  std::vector<CalibrationReport> reports;
  for (int set = 0; set < num_sets; ++set)
    reports.push_back(TestCalibration(AnswerPairs(pairs, set * num_pairs, (set + 1) * num_pairs)));
  return reports;
}

int NumWrong(const std::vector<CalibrationReport>& reports) {
  return static_cast<int>(
      std::ranges::count(reports, TruthFreeVerdict::kTooLarge, &CalibrationReport::verdict));
}
int NumFound(const std::vector<CalibrationReport>& reports, CameraFault fault) {
  return static_cast<int>(std::ranges::count_if(reports, [&](const CalibrationReport& report) {
    const TruthFreeVerdict verdict = report.faults[static_cast<size_t>(fault)].verdict;
    return verdict == TruthFreeVerdict::kTooLarge || verdict == TruthFreeVerdict::kTooSmall;
  }));
}

// 60 sets of 20 pairs without a fault: at a level of 0.05, 12 or more that find some fault are a false alarm
// of 4e-5; 11 or more verdicts on single faults, which are together 0.05 of a set, likewise. Independent
// noise, errors that neighbours within 80 px share, points that are found twice.
TEST(TestCalibration, HoldsItsLevel) {
  for (const Settings& noise :
       {Settings{}, Settings{{"noise", "correlated"}, {"noise_correlation_length_px", "80"}},
        Settings{{"noise", "duplicated"}}}) {
    const std::vector<CalibrationReport> reports = MakeReports(noise, 60, 20);
    EXPECT_LT(NumWrong(reports), 12) << noise.size();
    int num_found = 0;
    for (size_t j = 0; j < kNumNamedFaults; ++j) num_found += NumFound(reports, kCameraFaults[j]);
    EXPECT_LT(num_found, 12) << noise.size();
  }
}

// 20 sets of 20 pairs each; what a fault of this size gave in others was seen beforehand: some fault in nine
// sets of ten or more, so that less than 12 of 20 is a false alarm of 1e-4. The mean of the estimates lies
// within five standard errors, by their scatter, and a tenth of the fault: the step is one step.
TEST(TestCalibration, FindsFaults) {
  const std::vector<std::tuple<const char*, const char*, CameraFault, double>> faults = {
      {"focal_error", "0.005", CameraFault::kFocalLength, 0.005},
      {"principal_point_error_px", "3", CameraFault::kPrincipalPointY, 3.0},
      {"distortion_k1", "0.003", CameraFault::kDistortion, 0.003},
      {"rolling_shutter", "0.02", CameraFault::kReadoutTime, 0.02}};
  for (const auto& [key, value, fault, planted] : faults) {
    const std::vector<CalibrationReport> reports = MakeReports({{key, value}}, 20, 20);
    EXPECT_GE(NumWrong(reports), 12) << key;
    EXPECT_GE(NumFound(reports, fault), 5) << key;
    double sum = 0.0, squares = 0.0;
    for (const CalibrationReport& report : reports) {
      const double error = report.faults[static_cast<size_t>(fault)].joint.value - planted;
      sum += error;
      squares += error * error;
    }
    EXPECT_LT(std::abs(sum) / 20.0, 5.0 * std::sqrt(squares) / 20.0 + 0.1 * planted) << key;
  }
}

// What the twins show as well is no fault of the camera.
TEST(TestCalibration, DecidesNothingThatItsTwinsShowToo) {
  std::vector<PairAnswers> answers = AnswerPairs(SimulatePairs({{"focal_error", "0.02"}}, 20), 0, 20);
  const size_t focal = static_cast<size_t>(CameraFault::kFocalLength);
  EXPECT_EQ(TestCalibration(answers).faults[focal].verdict, TruthFreeVerdict::kTooLarge);
  for (PairAnswers& pair : answers) pair.twins = {pair.whole};
  EXPECT_EQ(TestCalibration(answers).faults[focal].verdict, TruthFreeVerdict::kUndecided);
}

TEST(DescribeFault, ByHand) {
  FaultReport report;
  report.joint = {0.0052, 0.0003, {0.0045, 0.006}, 9.0};
  report.verdict = TruthFreeVerdict::kTooLarge;
  EXPECT_EQ(DescribeFault(report), "0.52 % [0.45, 0.6] too long");
  report.joint = {-0.0052, 0.0003, {-0.006, -0.0045}, 9.0};
  report.verdict = TruthFreeVerdict::kTooSmall;
  EXPECT_EQ(DescribeFault(report), "0.52 % [0.45, 0.6] too short");
  report.joint = {0.0001, 0.0002, {-0.0003, 0.0005}, 9.0};
  report.verdict = TruthFreeVerdict::kHolds;
  EXPECT_EQ(DescribeFault(report), "holds (within +-0.05 %)");
  report.verdict = TruthFreeVerdict::kUndecided;
  report.alone = {0.01, 0.0002, {0.009, 0.011}, 9.0};
  report.confused_with = CameraFault::kDistortion;
  EXPECT_EQ(DescribeFault(report),
            "undecided: 0.01 % [-0.03, 0.05]; were it the only fault: 1 % [0.9, 1.1]; hard to tell from "
            "distortion k1");
}

TEST(CalibrationAdvice, SaysWhatToAssumeInstead) {
  CalibrationReport report;
  report.camera = {1010.0, 1010.0, 323.0, 240.0, 640, 480};
  report.faults = {
      {CameraFault::kFocalLength,
       {0.01, 0.001, {0.008, 0.012}, 9.0},
       {},
       {},
       TruthFreeVerdict::kTooLarge,
       {}},
      {CameraFault::kPrincipalPointX, {3.0, 0.1, {2.5, 3.5}, 9.0}, {}, {}, TruthFreeVerdict::kTooLarge, {}}};
  report.faults[0].correction = 0.01;
  report.faults[1].correction = 3.0;
  const std::vector<std::string> advice = CalibrationAdvice(report);
  ASSERT_EQ(advice.size(), 2u);
  EXPECT_THAT(advice[0], testing::HasSubstr("fx, fy = 1000, 1000 in place of 1010, 1010"));
  EXPECT_THAT(advice[1], testing::HasSubstr("cx = 320 in place of 323"));
}

// Pairs of other cameras than the first are not pooled with it; without pairs there is no data.
TEST(TestCalibration, PoolsOneCamera) {
  EXPECT_EQ(TestCalibration({}).verdict, TruthFreeVerdict::kNoData);
  std::vector<PairAnswers> answers;
  for (std::uint32_t i = 0; i < 3; ++i) {
    NamedPair pair{"", "", "", TwoCameraProblem(100, 0.5, 0.0, i)};
    RandomStream rng({.seed = 1, .trial = i, .purpose = 96});
    const MotionEstimate estimate = MakeEstimator("rcme_calibrated")->Estimate(pair.problem, rng);
    answers.push_back({{pair, estimate}, {}});
  }
  const CalibrationReport report = TestCalibration(answers);
  EXPECT_EQ(report.num_pairs, 0);
  EXPECT_EQ(report.verdict, TruthFreeVerdict::kNoData);
}

// The slope of key-point sizes: pairs whose matches' noise grows as noise_scale to the power `power`, where
// noise_scale itself is stated.
SizeReport MeasureSizes(double power, int num_pairs) {
  const auto estimator = MakeEstimator("rcme_calibrated");
  std::vector<PairAnswers> answers;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(num_pairs); ++i) {
    NamedPair pair{"pair " + std::to_string(i), "", "", TwoCameraProblem(300, 0.0, 0.0, i)};
    pair.problem.sigma_px = 0.4;
    RandomStream rng({.seed = 1, .trial = i, .purpose = 97});
    for (Correspondence& match : pair.problem.matches) {
      const double scale = std::exp(rng.Uniform(-1.1, 1.1)), sd_px = 0.3 * std::pow(scale, power);
      pair.problem.noise_scale.push_back(scale);
      for (double* x : {&match.x1_px.x(), &match.x1_px.y(), &match.x2_px.x(), &match.x2_px.y()})
        *x += sd_px * rng.Normal();
    }
    const auto answer = [&](const NamedPair& of) {
      return Answered{of, estimator->Estimate(of.problem, rng)};
    };
    answers.push_back({answer(pair), {}});
    for (std::uint32_t twin = 1; twin <= 2; ++twin)
      answers.back().twins.push_back(answer(MakeTwin(pair, answers.back().whole.estimate, 1, twin)));
  }
  return TestKeyPointSizes(answers);
}

// 16 pairs of 300 matches, scales from 1/3 to 3: the slope has a standard deviation of about 0.04. As stated;
// half as fast; not at all.
TEST(TestKeyPointSizes, FindsHowNoiseGrows) {
  const SizeReport stated = MeasureSizes(1.0, 16), half = MeasureSizes(0.5, 16), none = MeasureSizes(0.0, 16);
  EXPECT_EQ(stated.num_pairs, 16);
  EXPECT_NEAR(stated.slope.value, 1.0, 0.2) << DescribeSizeTest(stated);
  EXPECT_EQ(stated.verdict, TruthFreeVerdict::kHolds) << DescribeSizeTest(stated);
  EXPECT_NEAR(half.slope.value, 0.5, 0.2) << DescribeSizeTest(half);
  EXPECT_EQ(half.verdict, TruthFreeVerdict::kTooSmall) << DescribeSizeTest(half);
  EXPECT_NEAR(none.slope.value, 0.0, 0.2) << DescribeSizeTest(none);
  EXPECT_THAT(DescribeSizeTest(none), testing::HasSubstr("of what is stated"));
}

TEST(TestKeyPointSizes, WithoutSizesThereIsNoData) {
  EXPECT_EQ(TestKeyPointSizes({}).verdict, TruthFreeVerdict::kNoData);
  EXPECT_EQ(DescribeSizeTest({}), "no data");
  const SizeReport report = TestKeyPointSizes({{{{"", "", "", TwoCameraProblem(50, 0.5, 0.0, 1)}, {}}, {}}});
  EXPECT_EQ(report.num_pairs, 0);
}

}  // namespace
}  // namespace rcme
