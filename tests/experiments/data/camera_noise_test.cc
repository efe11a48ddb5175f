// The file of a camera's noise: what is written is read, what is no such file is refused, and a study draws
// it.
#include "experiments/data/camera_noise.h"

#include <gtest/gtest.h>

#include "experiments/data/make_data.h"
#include "experiments/real/truth_free/camera_faults.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"
#include "parameters/settings.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

CameraNoise MakeNoise() {
  CameraNoise noise;
  noise.num_pairs = 12;
  noise.num_matches = 3456;
  noise.effective_pairs = 9.5;
  noise.estimator = "rcme_calibrated";
  noise.camera = {700.5, 701.25, 319.5, 239.5, 640, 480};
  noise.sigma_px = {0.25, 0.01};
  noise.size_exponent = {0.5, 0.125};
  noise.key_point_px = 0.03;
  noise.displacement_px = {0.125, 0.02};
  noise.reach_px = 80.0;
  noise.reach_factor = 1.25;
  noise.corrections = {{0, {0.01, 0.001}, 0.0098, 0.0009}, {3, {0.02, 0.004}, 0.0, 0.003}};
  noise.correlations = {1.0, -0.5, -0.5, 1.0};
  noise.uncertainty_correlations = {1.0, 0.25, 0.25, 1.0};
  noise.seconds_between = 0.125;
  noise.systematic = {2, 1, {0.1, -0.2}, {0.3, 0.4}, 0.25, 0.002};
  return noise;
}

TEST(CameraNoiseFile, GivesBackWhatWasWritten) {
  const std::string yaml = CameraNoiseAsYaml(MakeNoise());
  const CameraNoise noise = ParseCameraNoise(yaml, "noise.yaml");
  EXPECT_EQ(CameraNoiseAsYaml(noise), yaml);
  EXPECT_EQ(noise.num_matches, 3456);
  EXPECT_EQ(noise.camera.fy, 701.25);
  EXPECT_EQ(noise.camera.height, 480);
  EXPECT_EQ(noise.sigma_px.value, 0.25);
  EXPECT_EQ(noise.size_exponent.value, 0.5);
  EXPECT_EQ(noise.DisplacementShare(), 0.25);
  ASSERT_EQ(noise.corrections.size(), 2u);
  EXPECT_EQ(noise.corrections[0].removed, 0.0098);
  EXPECT_EQ(noise.corrections[0].uncertainty, 0.0009);
  EXPECT_EQ(noise.corrections[1].removed, 0.0);
  EXPECT_EQ(noise.uncertainty_correlations, std::vector<double>({1.0, 0.25, 0.25, 1.0}));
  EXPECT_EQ(noise.corrections[1].fault, 3u);
  EXPECT_EQ(noise.systematic.dy_px, std::vector<double>({0.3, 0.4}));
}

TEST(CameraNoiseFile, WithoutWhatWasNotFoundIsShort) {
  CameraNoise noise = MakeNoise();
  noise.size_exponent = {};
  noise.displacement_px = {0.0, 0.0};
  noise.unseen_px = 0.03;
  noise.unseen_reach_px = 800.0;
  noise.corrections.clear();
  noise.correlations.clear();
  noise.uncertainty_correlations.clear();
  noise.systematic = {};
  const CameraNoise read = ParseCameraNoise(CameraNoiseAsYaml(noise), "noise.yaml");
  EXPECT_TRUE(std::isnan(read.size_exponent.value));
  EXPECT_EQ(read.DisplacementShare(), 0.0);
  EXPECT_EQ(read.unseen_px, 0.03);
  EXPECT_EQ(read.unseen_reach_px, 800.0);
  EXPECT_TRUE(read.corrections.empty());
  EXPECT_EQ(read.systematic.columns, 0);
}

TEST(CameraNoiseFile, WhatIsNoneIsRefused) {
  const std::string yaml = CameraNoiseAsYaml(MakeNoise());
  const auto refuses = [&](const std::string& from, const std::string& to,
                           const std::vector<std::string>& words) {
    std::string changed = yaml;
    EXPECT_NE(changed.find(from), std::string::npos) << from;
    changed.replace(changed.find(from), from.size(), to);
    return ThrowsInputError([&] { ParseCameraNoise(changed, "noise.yaml"); }, words);
  };
  EXPECT_TRUE(refuses("rcme_camera_noise", "name", {"noise.yaml", "no noise file", "calibrate-noise"}));
  EXPECT_TRUE(refuses("rcme_camera_noise: 1", "rcme_camera_noise: 2", {"noise.yaml:3", "version 1"}));
  EXPECT_TRUE(refuses("value: 0.25", "value: .nan", {"noise.yaml", "sigma_px", "[1e-09, 1000]"}));
  EXPECT_TRUE(refuses("value: 0.25", "value: -0.25", {"sigma_px", "-0.25"}));
  EXPECT_TRUE(refuses("reach_px: 80", "reach_px: 0", {"reach_px", "[0.1, 100000]"}));
  EXPECT_TRUE(refuses("key_point_px:", "key_points:", {"unknown key", "key_points"}));
  EXPECT_TRUE(refuses("key_point_px: 0.03\n", "", {"key 'key_point_px' is missing"}));
  EXPECT_TRUE(refuses("sd_px: 0.125", "sd_px: 0.3", {"sigma_px", "more variance"}));
  EXPECT_TRUE(refuses("dx_px: [0.1, -0.2]", "dx_px: [0.1]", {"dx_px", "2 numbers"}));
  EXPECT_TRUE(refuses("focal_length:", "focal:", {"focal"}));
  EXPECT_TRUE(refuses("uncertainty_correlations: [1, 0.25, 0.25, 1]\n", "", {"uncertainty_correlations"}));
  EXPECT_TRUE(refuses("[1, 0.25, 0.25, 1]", "[1, 0.25, 0.2, 1]", {"uncertainty_correlations", "symmetric"}));
  EXPECT_TRUE(refuses("uncertainty: 0.003", "uncertainty: -0.003", {"distortion", "-0.003"}));
  EXPECT_TRUE(refuses(", uncertainty: 0.003", "", {"distortion", "'uncertainty' is missing"}));
  EXPECT_TRUE(refuses("value: 0.25", "value: [1]", {"sigma_px"}));
  EXPECT_TRUE(refuses("value: 0.25", "value: .inf", {"sigma_px", "inf"}));
  EXPECT_TRUE(refuses("width: 640", "width: 640.5", {"width", "whole number"}));
  EXPECT_TRUE(refuses("columns: 2", "columns: 1.5", {"columns", "whole number"}));
  EXPECT_TRUE(refuses("columns: 2", "columns: 1000000", {"columns", "[1, 100]"}));
  EXPECT_TRUE(refuses("key_point_px: 0.03", "key_point_px: 0.03\nkey_point_px: 0.03", {"key_point_px"}));
  EXPECT_TRUE(ThrowsInputError([] { ParseCameraNoise("a: [", "noise.yaml"); }, {"noise.yaml"}));
  EXPECT_TRUE(ThrowsInputError([] { ParseCameraNoise("7", "noise.yaml"); }, {"no noise file"}));
  EXPECT_TRUE(ThrowsInputError([] { ReadCameraNoise("nowhere.yaml"); }, {"nowhere.yaml"}));
}

// What would make a covariance of no errors: asymmetric, not one on the diagonal, or indefinite.
TEST(CameraNoiseFile, RefusesCorrelationsThatAreNone) {
  const std::string yaml = CameraNoiseAsYaml(MakeNoise()), written = "correlations: [1, -0.5, -0.5, 1]";
  ASSERT_NE(yaml.find(written), std::string::npos);
  const auto refuses = [&](const std::string& list, const std::vector<std::string>& words) {
    std::string changed = yaml;
    changed.replace(changed.find(written), written.size(), "correlations: " + list);
    return ThrowsInputError([&] { ParseCameraNoise(changed, "noise.yaml"); }, words);
  };
  EXPECT_FALSE(refuses("[1, 0.999999, 0.999999, 1]", {"correlations"}));
  EXPECT_TRUE(refuses("[1, -0.5, 0.5, 1]", {"noise.yaml", "correlations", "symmetric"}));
  EXPECT_TRUE(refuses("[0.5, 0, 0, 1]", {"correlations", "diagonal"}));
  EXPECT_TRUE(refuses("[1, 1.5, 1.5, 1]", {"correlations", "[-1.0001, 1.0001]"}));
  EXPECT_TRUE(refuses("[1]", {"correlations", "4 numbers"}));
  CameraNoise noise = MakeNoise();
  noise.corrections.push_back({1, {0.0, 1.0}});
  noise.correlations = {1.0, -0.9, -0.9, -0.9, 1.0, -0.9, -0.9, -0.9, 1.0};
  EXPECT_TRUE(ThrowsInputError([&] { ParseCameraNoise(CameraNoiseAsYaml(noise), "noise.yaml"); },
                               {"correlations", "eigenvalue"}));
}

TEST(CameraNoiseFile, NamesTheFaultsOfTheCameraInTheirOrder) {
  ASSERT_EQ(kCorrectableFaults.size(), static_cast<size_t>(kNumNamedFaults));
  for (size_t i = 0; i < kCorrectableFaults.size(); ++i)
    EXPECT_STREQ(kCorrectableFaults[i], FindFaultText(kCameraFaults[i]).name);
}

// Not the path but the numbers are what the study is known by; keys beside it have precedence.
TEST(NoiseFromFile, IsTheDisplacementFieldOfTheFile) {
  const TempFolder folder;
  const std::string path = folder.Write("noise.yaml", CameraNoiseAsYaml(MakeNoise()));
  const Settings settings = {{"scene", "uniform_volume"}, {"noise", "from_file"}, {"noise_file", path}};
  const Settings resolved = ResolveSettings(settings);
  EXPECT_EQ(FindSetting(resolved, "noise"), "displacement_field");
  EXPECT_EQ(FindSetting(resolved, "sigma_px"), "0.25");
  EXPECT_EQ(FindSetting(resolved, "displacement_share"), "0.25");
  EXPECT_EQ(FindSetting(resolved, "displacement_reach_px"), "80");
  Settings beside = settings;
  beside.emplace_back("sigma_px", "0.5");
  EXPECT_EQ(FindSetting(ResolveSettings(beside), "sigma_px"), "0.5");
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        ResolveSettings({{"scene", "plane"}, {"noise", "from_file"}});
      },
      {"noise_file", "calibrate-noise"}));
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        ResolveSettings({{"scene", "plane"}, {"noise_file", path}});
      },
      {"unknown key 'noise_file'", "from_file"}));
  Study study = SmallStudy();
  for (const auto& [key, value] : settings) {
    if (key != "scene") study.data.emplace_back(key, value);
  }
  const StudyPlan plan = MakePlan(study);
  EXPECT_EQ(plan.study_yaml.find("noise.yaml"), std::string::npos);
}

}  // namespace
}  // namespace rcme
