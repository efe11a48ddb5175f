// Faults of a camera to convergence, which of them are named, and advice that is followed: rules by hand, the
// whole on simulated pairs with planted faults.
#include "experiments/real/truth_free/self_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "estimator/estimator_registry.h"
#include "experiments/real/truth_free/advice.h"
#include "experiments/real/truth_free/planted_fault.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

using testing::HasSubstr;

Eigen::Index At(CameraFault fault) { return static_cast<Eigen::Index>(fault); }

// Without what was planted the problem is what it was, to 1e-8 px.
TEST(RemoveFaults, UndoesWhatIsPlanted) {
  RelativePose pose;
  const MotionProblem exact = TwoCameraProblem(50, 0.5, 0.0, 1, &pose);
  FaultVector faults = FaultVector::Zero();
  faults.head<4>() << 0.03, 4.0, -7.0, 0.08;
  faults.segment<2>(At(CameraFault::kImage2ShiftX)) << 0.5, -0.3;
  const MotionProblem faulty = PlantFaults(exact, faults), again = RemoveFaults(faulty, pose, faults);
  EXPECT_NEAR(faulty.camera1.fx, 1.03 * exact.camera1.fx, 1e-9);
  EXPECT_NEAR(again.camera2.fy, exact.camera2.fy, 1e-9);
  EXPECT_NEAR(again.camera1.cy, exact.camera1.cy, 1e-9);
  double most_px = 0.0;
  for (size_t i = 0; i < exact.matches.size(); ++i) {
    EXPECT_LT((again.matches[i].x1_px - exact.matches[i].x1_px).norm(), 1e-8);
    EXPECT_LT((again.matches[i].x2_px - exact.matches[i].x2_px).norm(), 1e-8);
    most_px = std::max(most_px, (faulty.matches[i].x1_px - exact.matches[i].x1_px).norm());
  }
  EXPECT_GT(most_px, 1.0);
}

// To first order every fault is removed as ComputeShifts, which scores it, says: differences of a small step.
TEST(RemoveFaults, GoesAsTheShiftsSay) {
  RelativePose pose;
  const MotionProblem problem = TwoCameraProblem(20, 0.5, 0.0, 2, &pose);
  constexpr double kStep = 1e-5;
  for (const CameraFault fault : {CameraFault::kDistortion, CameraFault::kReadoutTime,
                                  CameraFault::kImage2ShiftX, CameraFault::kImage2ShiftY}) {
    const MotionProblem moved = RemoveFaults(problem, pose, kStep * FaultVector::Unit(At(fault)));
    for (size_t i = 0; i < problem.matches.size(); ++i) {
      const Correspondence &from = problem.matches[i], &to = moved.matches[i];
      Eigen::Vector4d by;
      by << to.x1_px - from.x1_px, to.x2_px - from.x2_px;
      const Eigen::Vector4d expected =
          -ComputeShifts(problem.camera1, problem.camera2, pose, from).col(At(fault));
      EXPECT_LT((by / kStep - expected).norm(), 1e-3 * expected.norm() + 1e-4) << FindFaultText(fault).name;
    }
  }
}

CalibrationReport MakeReport(double p_value,
                             const std::vector<std::pair<CameraFault, PooledParameter>>& faults) {
  CalibrationReport report;
  report.camera = {1000.0, 1000.0, 320.0, 240.0, 640, 480};
  report.num_pairs = 20;
  report.p_value = p_value;
  for (const auto& [fault, joint] : faults) {
    report.faults.push_back({fault, joint, joint, {0.0, 1.0, {-1.0, 1.0}, 9.0}, {}, {}});
  }
  JudgeFaults(&report);
  return report;
}

// k1 = 0.1, significant by its own interval. It is named beside a focal length that is determined, and not:
// where all faults together are not significant; beside a focal length of +-4,200 %; where the readout would
// take 1.8 times the time between images.
TEST(JudgeFaults, NamesNothingOutsideOfTheStepsRange) {
  const std::pair<CameraFault, PooledParameter> k1 = {CameraFault::kDistortion,
                                                      {0.1, 0.01, {0.07, 0.13}, 9.0}},
                                                focal = {CameraFault::kFocalLength,
                                                         {0.0, 0.01, {-0.03, 0.03}, 9.0}};
  EXPECT_TRUE(NamesFault(MakeReport(0.001, {focal, k1})));
  const CalibrationReport weak = MakeReport(0.13, {focal, k1});
  EXPECT_FALSE(NamesFault(weak));
  EXPECT_THAT(weak.why_unnamed, HasSubstr("not significant"));
  const CalibrationReport wide =
      MakeReport(0.001, {{CameraFault::kFocalLength, {-5.8, 14.0, {-48.0, 36.0}, 9.0}}, k1});
  EXPECT_FALSE(NamesFault(wide));
  EXPECT_THAT(DescribeCalibration(wide),
              HasSubstr("none is named: these pairs hardly determine the camera: focal"));
  EXPECT_THAT(DescribeCalibration(wide), HasSubstr("+-4.2e+03 %"));
  EXPECT_FALSE(NamesFault(MakeReport(0.001, {{CameraFault::kReadoutTime, {1.8, 0.1, {1.5, 2.1}, 9.0}}, k1})));
  // Half of what is possible: 0.25 either way is too wide, a little less is not.
  EXPECT_FALSE(
      NamesFault(MakeReport(0.001, {{CameraFault::kFocalLength, {0.0, 0.1, {-0.25, 0.251}, 9.0}}, k1})));
  EXPECT_TRUE(
      NamesFault(MakeReport(0.001, {{CameraFault::kFocalLength, {0.0, 0.1, {-0.25, 0.249}, 9.0}}, k1})));
}

// 20 pairs of 400 matches, noise 0.2 px, 5 % of them wrong.
PairSet MakeOwnPairs(const Settings& data = {}) {
  Study study = ParseStudy(
      "data: {scene: uniform_volume, num_matches: 400, sigma_px: 0.2, outlier_ratio: 0.05}\n"
      "estimators: [{name: rcme_calibrated}]\nseed: 8\ntrials: 20\n",
      "study.yaml");
  for (const auto& [key, value] : data) Override(&study, key, value);
  return PairSetsOfStudy(MakePlan(study)).front();
}
CalibrationReport CalibrateSet(const PairSet& set) {
  const auto estimator = MakeEstimator("rcme_calibrated");
  std::vector<PairAnswers> answers;
  for (const NamedPair& pair : set.pairs) {
    RandomStream rng({.seed = 8, .trial = static_cast<std::uint32_t>(answers.size()), .purpose = 122});
    answers.push_back({{pair, estimator->Estimate(pair.problem, rng)}, {}});
  }
  return Calibrate(answers, *estimator, 8);
}

// Faults of twenty times what is nominal, found in every one of some sets beforehand: named, estimated to
// five of its standard errors though one step is too short, and gone when corrected.
TEST(Calibrate, ConvergesToAGreatFault) {
  int most_steps = 0;
  for (const auto& [fault, planted] : {std::pair{CameraFault::kFocalLength, 0.06},
                                       {CameraFault::kDistortion, 0.03},
                                       {CameraFault::kImage2ShiftX, 2.0}}) {
    const CalibrationReport report =
        CalibrateSet(PlantFaultsIn(MakeOwnPairs(), {1.0, 1.0, planted * FaultVector::Unit(At(fault))}));
    const FaultReport& found = *std::ranges::find(report.faults, fault, &FaultReport::fault);
    EXPECT_TRUE(IsFault(found.verdict)) << FindFaultText(fault).name << ": " << DescribeCalibration(report);
    EXPECT_NEAR(found.joint.value, planted, 5.0 * found.joint.standard_error) << FindFaultText(fault).name;
    EXPECT_NEAR(found.correction, planted, 5.0 * found.joint.standard_error) << FindFaultText(fault).name;
    EXPECT_GE(report.p_corrected, 0.05);
    EXPECT_LE(report.num_steps, kMostSteps);
    most_steps = std::max(most_steps, report.num_steps);
  }
  EXPECT_GE(most_steps, 2);
}

// Key points that are shifted by 2 px, and k1 = 0.0032, which is not named beside six other faults (its
// interval is 0.0026 either way), but leaves p < 0.05 where the shift alone is corrected. It is named with
// it: beside the shift alone it is known to 0.0005.
TEST(Calibrate, CorrectsWhatIsLeftBesideAGreatFault) {
  FaultVector planted = FaultVector::Zero();
  planted(At(CameraFault::kImage2ShiftX)) = 2.0;
  planted(At(CameraFault::kDistortion)) = 0.0032;
  const CalibrationReport report = CalibrateSet(PlantFaultsIn(MakeOwnPairs(), {1.0, 1.0, planted}));
  for (const CameraFault fault : {CameraFault::kImage2ShiftX, CameraFault::kDistortion}) {
    const FaultReport& found = *std::ranges::find(report.faults, fault, &FaultReport::fault);
    EXPECT_TRUE(IsFault(found.verdict)) << FindFaultText(fault).name << ": " << DescribeCalibration(report);
    EXPECT_NEAR(found.correction, planted(At(fault)), 5.0 * found.joint.standard_error)
        << FindFaultText(fault).name;
  }
  EXPECT_GE(report.p_corrected, 0.05);
}

// Kinds of fault that are none of those that are named, and look like them: tangential distortion along
// either axis. They are seen and given no other's name.
TEST(Calibrate, GivesAFurtherKindOfFaultNoName) {
  for (const CameraFault fault : {CameraFault::kTangentialX, CameraFault::kTangentialY}) {
    PairSet set = MakeOwnPairs();
    for (NamedPair& pair : set.pairs) {
      MotionProblem& problem = pair.problem;
      for (Correspondence& match : problem.matches) {
        const Eigen::Vector4d shift = ComputeShifts(problem.camera1, problem.camera2,
                                                    {Eigen::Matrix3d::Identity(), {1.0, 0.0, 0.0}}, match)
                                          .col(At(fault));
        match.x1_px += 0.02 * shift.head<2>();
        match.x2_px += 0.02 * shift.tail<2>();
      }
    }
    const CalibrationReport report = CalibrateSet(set);
    EXPECT_LT(report.p_value, 0.05) << FindFaultText(fault).name;
    EXPECT_FALSE(NamesFault(report)) << FindFaultText(fault).name << ": " << DescribeCalibration(report);
    EXPECT_THAT(report.why_unnamed, HasSubstr("something of another kind is left"));
  }
}

// A readout is asked of pairs that state the time between their images, and of no others.
TEST(Calibrate, AsksPhotographsForNoReadout) {
  PairSet set = MakeOwnPairs();
  const auto has_readout = [](const CalibrationReport& report) {
    return std::ranges::count(report.faults, CameraFault::kReadoutTime, &FaultReport::fault) == 1;
  };
  EXPECT_TRUE(has_readout(CalibrateSet(set)));
  set.pairs[3].seconds_between = std::nan("");
  EXPECT_FALSE(has_readout(CalibrateSet(set)));
}

// Intrinsics that differ by rounding are of one camera, others not.
TEST(Calibrate, PoolsPairsOfOneCamera) {
  PairSet set = MakeOwnPairs();
  set.pairs[4].problem.camera2.fx *= 1.0 + 1e-6;
  EXPECT_EQ(CalibrateSet(set).num_pairs, 20);
  set.pairs[4].problem.camera2.fx *= 1.001;
  EXPECT_EQ(CalibrateSet(set).num_pairs, 19);
}

TEST(ReadoutScales, AreMedianTimesOverOwn) {
  PairSet set = MakeOwnPairs();
  std::vector<PairAnswers> answers;
  for (const double seconds : {0.1, 0.2, 0.4}) {
    answers.push_back({{set.pairs[0], {}}, {}});
    answers.back().whole.pair.seconds_between = seconds;
  }
  EXPECT_THAT(ReadoutScales(answers), testing::ElementsAre(2.0, 1.0, 0.5));
}

AdvisedEstimator Advised(double factor) {
  return {[factor](const Settings& options) {
            return ScaleCovariances(MakeEstimator("rcme_calibrated", options), factor);
          },
          false, 1.0};
}

// Covariances a hundred times too small: found, the estimator's own, and the advice restores them: measured
// on what it advises. A covariance of zero is found; no factor of zero helps, and the advice says so.
TEST(ValidateAndAdvise, MeasuresWhatItAdvises) {
  const SetReport small = ValidateAndAdvise(MakeOwnPairs(), Advised(0.01), {1, 2});
  EXPECT_EQ(small.covariances.verdict, TruthFreeVerdict::kTooSmall);
  EXPECT_EQ(small.covariances.cause, FaultCause::kEstimator);
  ASSERT_FALSE(small.advice.empty());
  EXPECT_THAT(small.advice.back(), HasSubstr("covariance_factor="));
  EXPECT_THAT(small.advice.back(), testing::AnyOf(testing::EndsWith("]), covariances: undecided"),
                                                  HasSubstr("followed: covariances: undecided"),
                                                  HasSubstr("followed: covariances: holds")));
  EXPECT_THAT(small.advice.back(), testing::Not(HasSubstr("does not make them hold")));
  const SetReport zero = ValidateAndAdvise(MakeOwnPairs(), Advised(0.0), {1, 1});
  EXPECT_EQ(zero.covariances.verdict, TruthFreeVerdict::kTooSmall);
  EXPECT_THAT(zero.advice.back(), HasSubstr("does not make them hold"));
}

// A sigma half of what it is: found, and gone when followed.
TEST(ValidateAndAdvise, FollowsTheAssumedSigma) {
  const SetReport report = ValidateAndAdvise(PlantFaultsIn(MakeOwnPairs(), {1.0, 0.5}), Advised(1.0), {1, 1});
  EXPECT_EQ(report.sigma_verdict, TruthFreeVerdict::kTooSmall);
  EXPECT_THAT(report.advice,
              testing::Contains(HasSubstr("the assumed sigma, 0.1 px, is too small: assume 0.2")));
}

TEST(ParsePlantedFaults, TakesNamesAndRefusesOthers) {
  const PlantedFaults faults =
      ParsePlantedFaults({"covariance=0.25", "focal_length=0.01", "image2_shift_y=-0.5"});
  EXPECT_EQ(faults.covariance, 0.25);
  EXPECT_EQ(faults.camera(At(CameraFault::kFocalLength)), 0.01);
  EXPECT_EQ(faults.camera(At(CameraFault::kImage2ShiftY)), -0.5);
  for (const char* bad :
       {"focal_length", "readout_time=0.1", "aspect_ratio=0.1", "covariance=0", "=1", "sigma=x"})
    EXPECT_THROW(ParsePlantedFaults({bad}), InputError) << bad;
}

}  // namespace
}  // namespace rcme
