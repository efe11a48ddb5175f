#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "estimator/undistortion.h"
#include "experiments/data/make_data.h"
#include "simulator/exact_match.h"
#include "simulator/noise/noise_laws.h"
#include "stats/constants.h"

namespace rcme {
namespace {

const StreamName kName{1, 0, 0, 0};

// Two cameras of different focal lengths, half of the matches wrong.
std::shared_ptr<const SimulatedData> DataWith(const Settings& more) {
  Settings settings = {{"scene", "uniform_volume"},
                       {"cameras", "euroc_and_office"},
                       {"num_matches", "40"},
                       {"outlier_ratio", "0.5"},
                       {"sigma_px", "0.5"}};
  settings.insert(settings.end(), more.begin(), more.end());
  return MakeSimulatedData(settings);
}

// Catches one camera given for both.
TEST(SimulatedData, EachCameraIsToldWithTheErrorOfItsOwnFocalLength) {
  const auto data = DataWith({{"focal_error", "0.1"}});
  const Scene scene = data->DrawScene(kName);
  const MotionProblem problem = data->MakeFrom(scene, kName).problem;
  ASSERT_NE(scene.camera1.fx, scene.camera2.fx);
  EXPECT_DOUBLE_EQ(problem.camera1.fx, 1.1 * scene.camera1.fx);
  EXPECT_DOUBLE_EQ(problem.camera2.fx, 1.1 * scene.camera2.fx);
}

// How hard a problem is does not depend on what an estimator assumes.
TEST(SimulatedData, SeverityIsThatOfTheTrueNoise) {
  const TrialData right = DataWith({})->Make(kName),
                  wrong = DataWith({{"assumed_sigma_px", "2"}})->Make(kName);
  EXPECT_EQ(right.problem.sigma_px, 0.5);
  EXPECT_EQ(wrong.problem.sigma_px, 2.0);
  EXPECT_GT(right.severity.crb_rotation_deg, 0.0);
  EXPECT_EQ(wrong.severity.crb_rotation_deg, right.severity.crb_rotation_deg);
}

// Catches a stream that two of them share: noise and wrong matches would depend on each other.
TEST(SimulatedData, NoiseAndWrongMatchesHaveStreamsOfTheirOwn) {
  const auto data = DataWith({});
  const Scene scene = data->DrawScene(kName);
  RandomStream noise_rng = StreamFor(kName, StreamPurpose::kNoise);
  RandomStream outlier_rng = StreamFor(kName, StreamPurpose::kOutliers);
  const Observation expected =
      Observe(scene, *MakeGaussianNoise(0.5), OutlierModel(0.5), noise_rng, outlier_rng);
  const TrialData made = data->MakeFrom(scene, kName);
  ASSERT_EQ(made.problem.matches.size(), expected.matches.size());
  for (size_t i = 0; i < expected.matches.size(); ++i) {
    EXPECT_EQ(made.problem.matches[i].x1_px, expected.matches[i].x1_px);
    EXPECT_EQ(made.problem.matches[i].x2_px, expected.matches[i].x2_px);
  }
}

// The defects of the cameras move the matches of the same scene and leave the truth alone.
TEST(SimulatedData, CamerasHaveTheDefectsThatTheStudyGivesThem) {
  const TrialData ideal = DataWith({})->Make(kName);
  for (const char* key : {"distortion_k1", "rolling_shutter"}) {
    const TrialData made = DataWith({{key, "0.02"}})->Make(kName);
    EXPECT_EQ(made.truth.cam2_from_cam1_true->R, ideal.truth.cam2_from_cam1_true->R);
    double greatest_px = 0.0;
    for (size_t i = 0; i < ideal.problem.matches.size(); ++i) {
      if (!ideal.truth.is_inlier_true[i]) continue;
      greatest_px =
          std::max(greatest_px, (made.problem.matches[i].x1_px - ideal.problem.matches[i].x1_px).norm());
    }
    EXPECT_GT(greatest_px, 0.05) << key;
    EXPECT_LT(greatest_px, 50.0) << key;
  }
}

// Estimators get pinhole cameras and undistorted matches, and how noisy each is: without noise and wrong
// matches they satisfy the true motion, and scales are those of the two images.
TEST(SimulatedData, BehindALensEstimatorsGetUndistortedMatches) {
  for (const char* cameras : {"radtan", "fisheye"}) {
    const auto data = DataWith({{"cameras", cameras}, {"sigma_px", "1e-9"}, {"outlier_ratio", "0"}});
    const Scene scene = data->DrawScene(kName);
    const TrialData made = data->MakeFrom(scene, kName);
    ASSERT_EQ(made.problem.matches.size(), 40u);
    ASSERT_EQ(made.problem.noise_scale.size(), 40u);
    EXPECT_EQ(made.problem.camera1.fx, scene.camera1.fx);
    const Lens lens1 = scene.camera1.AsLens(), lens2 = scene.camera2.AsLens();
    for (size_t i = 0; i < 40; ++i) {
      const Eigen::Vector3d& point = scene.points_in_cam1[made.scene_point[i]];
      const Correspondence expected = PinholeMatch(scene, point);
      EXPECT_LT((made.problem.matches[i].x1_px - expected.x1_px).norm(), 1e-4);
      EXPECT_LT((made.problem.matches[i].x2_px - expected.x2_px).norm(), 1e-4);
      EXPECT_NEAR(made.problem.sigma_px * made.problem.noise_scale[i],
                  1e-9 * UndistortMatch(lens1, lens2, ExactMatch(scene, point))->noise_ratio, 1e-13);
    }
  }
}

// What the noise of the detector says and what undistortion does multiply.
TEST(SimulatedData, ScalesOfDetectorAndLensMultiply) {
  const Settings octaves = {{"noise", "octave"}, {"stated_growth", "1"}, {"outlier_ratio", "0"}};
  Settings with_lens = octaves;
  with_lens.push_back({"cameras", "radtan"});
  const auto data = DataWith(with_lens);
  const Scene scene = data->DrawScene(kName);
  const TrialData made = data->MakeFrom(scene, kName);
  std::vector<double> levels;
  for (size_t i = 0; i < made.problem.matches.size(); ++i) {
    const Correspondence exact = ExactMatch(scene, scene.points_in_cam1[made.scene_point[i]]);
    const double ratio = UndistortMatch(scene.camera1.AsLens(), scene.camera2.AsLens(), exact)->noise_ratio;
    const double level =
        std::log(made.problem.sigma_px * made.problem.noise_scale[i] / ratio) / std::log(1.2);
    levels.push_back(level - std::floor(level + 0.5));
  }
  // Sigmas without the lens are those of the pyramid's levels, which differ by powers of 1.2; noise has moved
  // the points, and so the ratio, by next to nothing.
  const auto [least, greatest] = std::ranges::minmax(levels);
  EXPECT_TRUE(greatest - least < 0.1 || greatest - least > 0.9) << least << " " << greatest;
}

// Matches at pixels that no ray reaches are left out, with all that is known of them.
TEST(SimulatedData, WhatNoRayReachesIsLeftOut) {
  const auto data = DataWith({{"cameras", "radtan"},
                              {"num_matches", "400"},
                              {"lens_k1", "-0.5"},
                              {"lens_k2", "0"},
                              {"focal_px", "300"},
                              {"sigma_px", "3"}});
  const TrialData made = data->Make(kName);
  const size_t n = made.problem.matches.size();
  EXPECT_LT(n, 400u);
  EXPECT_GT(n, 350u);
  EXPECT_EQ(made.truth.is_inlier_true.size(), n);
  EXPECT_EQ(made.truth.is_undetectable.size(), n);
  EXPECT_EQ(made.scene_point.size(), n);
  EXPECT_EQ(made.problem.noise_scale.size(), n);
}

// What a sensor measures is drawn from the truth by a stream of its own: matches and truth stay.
TEST(SimulatedData, SensorsMakeAPriorAndChangeNothingElse) {
  const TrialData without = DataWith({})->Make(kName);
  EXPECT_FALSE(without.problem.prior.has_value());
  const TrialData with =
      DataWith(
          {{"prior_rotation_sd_deg", "0.5"}, {"prior_gravity_sd_deg", "1"}, {"prior_direction_sd_deg", "5"}})
          ->Make(kName);
  const std::optional<MotionPrior>& prior = with.problem.prior;
  ASSERT_TRUE(prior && prior->rotation && prior->gravity && prior->direction);
  EXPECT_EQ(FindPriorFault(*prior), "");
  EXPECT_NEAR(std::sqrt(prior->rotation->cov(1, 1)), 0.5 * kRadPerDeg, 1e-15);
  EXPECT_EQ(prior->gravity->sd2_rad, kRadPerDeg);
  EXPECT_EQ(prior->direction->sd_rad, 5.0 * kRadPerDeg);
  // Chi-square with seven degrees of freedom at the truth: beyond 45 once in 1e7.
  const RelativePose& truth = *with.truth.cam2_from_cam1_true;
  EXPECT_LT(2.0 * EvaluatePrior(*prior, truth).cost, 45.0);
  EXPECT_GT(2.0 * EvaluatePrior(*prior, truth).cost, 0.1);
  ASSERT_EQ(with.problem.matches.size(), without.problem.matches.size());
  for (size_t i = 0; i < with.problem.matches.size(); ++i) {
    EXPECT_EQ(with.problem.matches[i].x1_px, without.problem.matches[i].x1_px);
    EXPECT_EQ(with.problem.matches[i].x2_px, without.problem.matches[i].x2_px);
  }
  EXPECT_EQ(truth.R, without.truth.cam2_from_cam1_true->R);
}

TEST(SimulatedData, ABiasTurnsTheMeasurementAndNotItsCovariance) {
  const auto measure = [](const char* bias) {
    return *DataWith({{"prior_rotation_sd_deg", "0.1"}, {"prior_bias_deg", bias}})
                ->Make(kName)
                .problem.prior->rotation;
  };
  const RotationPrior right = measure("0"), wrong = measure("5");
  EXPECT_EQ(right.cov, wrong.cov);
  EXPECT_NEAR(RotationAngleBetween(right.R, wrong.R), 5.0 * kRadPerDeg, 1e-9);
}

// Catches noise of given numbers that leaves the defects out.
TEST(SimulatedData, GivenNoiseComesOnTopOfTheDefects) {
  const std::vector<double> none(160, 0.0);
  const auto matches_with = [&](const Settings& more) {
    Settings settings = {{"outlier_ratio", "0"}};
    settings.insert(settings.end(), more.begin(), more.end());
    const auto data = DataWith(settings);
    RandomStream rng = StreamFor(kName, StreamPurpose::kOutliers);
    return data->MakeFrom(data->DrawScene(kName), none, rng).problem.matches;
  };
  const std::vector<Correspondence> ideal = matches_with({}), bent = matches_with({{"distortion_k1", "0.1"}});
  double greatest_px = 0.0;
  for (size_t i = 0; i < ideal.size(); ++i)
    greatest_px = std::max(greatest_px, (ideal[i].x1_px - bent[i].x1_px).norm());
  EXPECT_GT(greatest_px, 1.0);
}

}  // namespace
}  // namespace rcme
