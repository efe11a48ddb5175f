#include <gtest/gtest.h>

#include "experiments/data/make_data.h"
#include "simulator/noise/noise_laws.h"

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

}  // namespace
}  // namespace rcme
