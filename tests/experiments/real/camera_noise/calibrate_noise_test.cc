// What is planted in simulated pairs of one camera is found, with known rates, and its file makes covariances
// hold again.
#include "experiments/real/camera_noise/calibrate_noise.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "estimator/estimator_registry.h"
#include "estimator/estimators/rcme_calibrated.h"
#include "estimator/refinement/sampson_mle.h"
#include "estimator/robust_covariance/covariance_option.h"
#include "experiments/real/camera_noise/apply_noise.h"
#include "experiments/real/camera_noise/calibrate_noise_output.h"
#include "experiments/real/camera_noise/fitted_pairs.h"
#include "experiments/real/camera_noise/systematic_displacement.h"
#include "experiments/real/truth_free/halves.h"
#include "experiments/real/truth_free/planted_fault.h"
#include "experiments/real/truth_free/validate.h"
#include "experiments/study/study_file.h"
#include "stats/constants.h"
#include "stats/random.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

using testing::HasSubstr;

constexpr double kChiSquare5 = 11.0705;  // 95 %

struct TakenPairs {
  PairSet set;
  std::vector<RelativePose> motions_true;
};

// 20 pairs of one camera, 300 matches each, noise 0.2 px, 5 % of them wrong.
TakenPairs TakePairs(std::uint64_t seed, const Settings& data = {},
                     const FaultVector& faults = FaultVector::Zero()) {
  Study study = ParseStudy(
      "data: {scene: uniform_volume, num_matches: 300, sigma_px: 0.2, outlier_ratio: 0.05, severity: "
      "skipped}\n"
      "estimators: [{name: rcme_calibrated}]\ntrials: 20\n",
      "study.yaml");
  study.seed = seed;
  for (const auto& [key, value] : data) Override(&study, key, value);
  const StudyPlan plan = MakePlan(study);
  TakenPairs taken{PlantFaultsIn(PairSetsOfStudy(plan).front(), {1.0, 1.0, faults}), {}};
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const TrialData drawn = plan.conditions[0].source->Make(NameOfScene(plan, plan.conditions[0], trial));
    taken.motions_true.push_back(*drawn.truth.cam2_from_cam1_true);
  }
  return taken;
}

NoiseCalibration CalibrateTaken(const TakenPairs& taken, std::uint64_t seed) {
  return CalibrateNoise(taken.set, *MakeEstimator("rcme_calibrated"), "rcme_calibrated", seed);
}

// Without errors of the calibration that nobody stated, which would widen the regions.
std::unique_ptr<MotionEstimator> MakeTrustingTheCalibration() {
  CalibratedOptions options;
  options.unstated_errors = 0.0;
  return MakeRcmeCalibrated(options);
}

// Shares of motions, and of differences between halves of the images, within their 95 % regions.
struct Covered {
  double num_motions = 0.0, motions = 0.0, num_halves = 0.0, halves = 0.0;
};
void CountCovered(const PairSet& set, const std::vector<RelativePose>& motions_true,
                  const MotionEstimator& estimator, Covered* covered) {
  for (size_t i = 0; i < set.pairs.size(); ++i) {
    const StreamName name{7, 1, static_cast<std::uint32_t>(i), 0};
    RandomStream rng({.seed = 7, .trial = static_cast<std::uint32_t>(i), .purpose = 123});
    const MotionProblem& problem = set.pairs[i].problem;
    const MotionEstimate estimate = estimator.Estimate(problem, rng);
    if (estimate.status != MotionStatus::kOk) continue;
    const Vector5d error = LocalCoordinates(estimate.cam2_from_cam1, motions_true[i]);
    ++covered->num_motions;
    covered->motions += error.dot(estimate.pose_cov.ldlt().solve(error)) < kChiSquare5;
    for (const Split split : kSpatialSplits) {
      const auto difference = DifferenceOfHalves(problem, estimate, split, estimator, name);
      if (!difference) continue;
      ++covered->num_halves;
      covered->halves += *difference < kChiSquare5;
    }
  }
}

// Independent noise, 30 cameras. Beforehand, in 120 others: a camera fault is named in 4, a displacement
// field found in 8, one of all images in 7, and sigma lies within its interval in 112. At these rates more
// than 5, 6 and 6, or fewer than 24 of 30, come about once in a hundred sets of cameras or more seldom.
TEST(CalibrateNoise, NamesNothingInIndependentNoise) {
  int num_faults = 0, num_fields = 0, num_systematic = 0, num_sigma_within = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const NoiseCalibration found = CalibrateTaken(TakePairs(seed), seed);
    num_faults += NamesFault(found.faults);
    num_fields += found.shared.is_found;
    num_systematic += found.noise.systematic.columns > 0;
    num_sigma_within += found.variance.interval.Contains(0.04);
    EXPECT_NEAR(found.noise.sigma_px.value, 0.2, 0.02) << seed;
  }
  EXPECT_LE(num_faults, 5);
  EXPECT_LE(num_fields, 6);
  EXPECT_LE(num_systematic, 6);
  EXPECT_GE(num_sigma_within, 24);
}

// Half as much again as is assumed: found, and nothing else.
TEST(CalibrateNoise, FindsTheSizeOfTheNoise) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const NoiseCalibration found =
        CalibrateTaken(TakePairs(seed, {{"sigma_px", "0.3"}, {"assumed_sigma_px", "0.2"}}), seed);
    EXPECT_NEAR(found.noise.sigma_px.value, 0.3, 4.0 * found.noise.sigma_px.standard_error) << seed;
    EXPECT_LT(found.noise.sigma_px.standard_error, 0.01);
    EXPECT_EQ(found.noise.displacement_px.value, 0.0);
  }
}

// A field of 30 % of the variance, reaching 80 and 150 px, is found in every camera, its size to a third and
// its reach to a factor of 3.5. Beforehand, learnt from ten pairs of 12 other cameras and applied to ten more
// of each: reaches of 97 and 208 px (geometric means); within their regions of 95 % are 51 % and 24 % of
// motions without the file and 94 % and 95 % with it, of halves 80 % and 72 %, then 97 % and 98 %.
TEST(CalibrateNoise, FindsADisplacementFieldAndCoverageComesBack) {
  const auto estimator = MakeTrustingTheCalibration();
  for (const double reach_px : {80.0, 150.0}) {
    Covered before, after;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const TakenPairs taken = TakePairs(seed, {{"noise", "displacement_field"},
                                                {"displacement_share", "0.3"},
                                                {"displacement_reach_px", fmt::format("{}", reach_px)}});
      const NoiseCalibration found = CalibrateTaken(taken, seed);
      ASSERT_TRUE(found.shared.is_found) << reach_px << " " << seed;
      EXPECT_NEAR(found.noise.displacement_px.value / 0.10954, 1.0, 0.6);
      EXPECT_LT(std::abs(std::log(found.noise.reach_px / reach_px)), std::log(3.5));
      CountCovered(taken.set, taken.motions_true, *estimator, &before);
      CountCovered(ApplyNoiseTo(taken.set, found.noise, *estimator, seed), taken.motions_true,
                   *WithSharedNoise(MakeEstimator("rcme_calibrated"), found.noise, false), &after);
    }
    EXPECT_LT(before.motions / before.num_motions, 0.65) << reach_px;
    EXPECT_LT(before.halves / before.num_halves, 0.88) << reach_px;
    EXPECT_GT(after.motions / after.num_motions, 0.82) << reach_px;
    EXPECT_GT(after.halves / after.num_halves, 0.9) << reach_px;
  }
}

// Removed, within four times what is uncertain of it, of three cameras of four at least; the regions hold
// again, since they know what is uncertain. Coverage of ten further pairs: results/calibrate_noise.
TEST(CalibrateNoise, RemovesFaultsOfTheCameraAndCoverageComesBack) {
  const auto estimator = MakeTrustingTheCalibration();
  for (const auto& [fault, planted] : {std::pair{CameraFault::kDistortion, 0.01},
                                       {CameraFault::kFocalLength, 0.01},
                                       {CameraFault::kPrincipalPointX, 5.0}}) {
    Covered before, after;
    int num_removed = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const auto index = static_cast<Eigen::Index>(fault);
      const TakenPairs taken = TakePairs(seed, {}, planted * FaultVector::Unit(index));
      const NoiseCalibration found = CalibrateTaken(taken, seed);
      for (const CameraCorrection& each : found.noise.corrections) {
        if (each.fault != static_cast<size_t>(index) || each.removed == 0.0) continue;
        ++num_removed;
        EXPECT_NEAR(each.removed, planted, 4.0 * each.uncertainty) << seed;
      }
      CountCovered(taken.set, taken.motions_true, *estimator, &before);
      CountCovered(ApplyNoiseTo(taken.set, found.noise, *estimator, seed), taken.motions_true,
                   *WithSharedNoise(MakeEstimator("rcme_calibrated"), found.noise, false), &after);
    }
    EXPECT_GE(num_removed, 3) << FindFaultText(fault).name;
    EXPECT_LT(before.motions / before.num_motions, 0.7) << FindFaultText(fault).name;
    EXPECT_GT(after.motions / after.num_motions, 0.85) << FindFaultText(fault).name;
    EXPECT_GT(after.halves / after.num_halves, 0.9) << FindFaultText(fault).name;
  }
}

// A focal length that is 1 % off, learnt from ten pairs: of eight cameras some have it named and some do not,
// and motions of ten further pairs are within their regions in either case.
TEST(CalibrateNoise, RegionsHoldWhereAFaultIsNotNamed) {
  const auto estimator = MakeTrustingTheCalibration();
  Covered before, after;
  int num_named = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    TakenPairs learnt = TakePairs(seed, {}, 0.01 * FaultVector::Unit(0)), checked = learnt;
    learnt.set.pairs.resize(10);
    checked.set.pairs.erase(checked.set.pairs.begin(), checked.set.pairs.begin() + 10);
    checked.motions_true.erase(checked.motions_true.begin(), checked.motions_true.begin() + 10);
    const NoiseCalibration found = CalibrateTaken(learnt, seed);
    if (NamesFault(found.faults)) {
      ++num_named;
      continue;
    }
    CountCovered(checked.set, checked.motions_true, *estimator, &before);
    CountCovered(ApplyNoiseTo(checked.set, found.noise, *estimator, seed), checked.motions_true,
                 *WithSharedNoise(MakeEstimator("rcme_calibrated"), found.noise, false), &after);
  }
  ASSERT_LE(num_named, 6);
  EXPECT_LT(before.motions / before.num_motions, 0.3);
  EXPECT_GT(after.motions / after.num_motions, 0.8);
}

// What pairs of 10 % of the variance in a field of 1,000 px do not show is to be expected all the same.
TEST(ExpectVariance, IsRightOnAverage) {
  RandomStream rng({.seed = 6, .purpose = 131});
  constexpr int kNumCameras = 20000;
  constexpr double kTotal = 0.04, kSd = 0.0016;
  double sum = 0.0, squares = 0.0, among_high = 0.0, squares_high = 0.0;
  for (int camera = 0; camera < kNumCameras; ++camera) {
    const double v = rng.Uniform() < 0.5 ? 0.0 : kTotal * std::pow(0.01, rng.Uniform());
    PooledParameter estimate;
    estimate.value = v + kSd * rng.Normal();
    estimate.interval = {estimate.value - 1.959964 * kSd, estimate.value + 1.959964 * kSd};
    const double off = ExpectVariance(estimate, kTotal) - v;
    sum += off;
    squares += off * off;
    if (estimate.value < kSd) continue;  // about half of the cameras
    among_high += off;
    squares_high += off * off;
  }
  EXPECT_LT(std::abs(sum), 4.0 * std::sqrt(squares));
  EXPECT_LT(std::abs(among_high), 4.0 * std::sqrt(squares_high));
  PooledParameter nothing;
  nothing.value = kNaN;
  nothing.interval = {-kInfinity, kInfinity};
  EXPECT_EQ(ExpectVariance(nothing, kTotal), 0.0);
}

// A swirl of 0.3 px that no fault of the list explains: found, and where matches are most of it removed.
TEST(CalibrateNoise, FindsADisplacementOfAllImages) {
  TakenPairs taken = TakePairs(3);
  const auto swirl = [](const Eigen::Vector2d& x_px) {
    return Eigen::Vector2d(0.3 * std::sin(x_px.y() / 60.0), 0.3 * std::cos(x_px.x() / 75.0));
  };
  for (NamedPair& pair : taken.set.pairs) {
    for (Correspondence& match : pair.problem.matches) {
      match.x1_px += swirl(match.x1_px);
      match.x2_px += swirl(match.x2_px);
    }
  }
  const NoiseCalibration found = CalibrateTaken(taken, 3);
  EXPECT_LT(found.systematic.p_value, 0.001);
  ASSERT_GT(found.noise.systematic.columns, 0);
  EXPECT_THAT(MakeNoiseCalibrationResult(found, "swirl").text, HasSubstr("removed"));
  double before = 0.0, after = 0.0;
  for (double x = 100.0; x <= 540.0; x += 20.0) {
    for (double y = 80.0; y <= 400.0; y += 20.0) {
      const Eigen::Vector2d at(x, y), is = swirl(at);
      before += is.squaredNorm();
      after += (is - DisplacementAt(found.noise.systematic, found.noise.camera, at)).squaredNorm();
    }
  }
  EXPECT_LT(after, 0.6 * before);
}

// A detector whose noise grows as its stated size says, or not at all.
TEST(FitSizeExponent, IsThatOfTheNoise) {
  const auto estimator = MakeEstimator("rcme_calibrated");
  for (const double growth : {0.0, 0.5, 1.0}) {
    const TakenPairs taken = TakePairs(
        2, {{"noise", "octave"}, {"octave_growth", fmt::format("{}", growth)}, {"stated_growth", "1"}});
    const NoiseCalibration found = CalibrateTaken(taken, 2);
    EXPECT_NEAR(found.noise.size_exponent.value, growth, 4.0 * found.noise.size_exponent.standard_error);
    EXPECT_LT(found.noise.size_exponent.standard_error, 0.1);
    EXPECT_GE(found.sizes.size(), 3u);
    const MotionProblem applied = ApplyNoise(taken.set.pairs[0].problem, found.noise, "pair");
    EXPECT_EQ(applied.sigma_px, found.noise.sigma_px.value);
    EXPECT_NEAR(applied.noise_scale[3],
                std::pow(taken.set.pairs[0].problem.noise_scale[3], found.noise.size_exponent.value), 1e-12);
  }
}

// G Sigma G' against a refit: the least-squares motion of matches with a fault less that without it. The
// noise is small, since G leaves out the curvature of the residuals.
TEST(WidenCovariance, AddsHowFarAnErrorOfWhatIsRemovedMovesTheMotion) {
  const TakenPairs taken = TakePairs(1, {{"outlier_ratio", "0"}, {"sigma_px", "0.02"}});
  const auto estimator = MakeEstimator("rcme_calibrated");
  for (const auto& [fault, error] : {std::pair{CameraFault::kFocalLength, 1e-4},
                                     {CameraFault::kPrincipalPointY, 0.01},
                                     {CameraFault::kDistortion, 1e-4}}) {
    const MotionProblem& problem = taken.set.pairs[4].problem;
    RandomStream rng({.seed = 1, .purpose = 124});
    MotionEstimate estimate = estimator->Estimate(problem, rng);
    ASSERT_EQ(estimate.status, MotionStatus::kOk);
    const auto refit = [&](double by) {
      const MotionProblem moved =
          PlantFaults(problem, by * FaultVector::Unit(static_cast<Eigen::Index>(fault)));
      return RefineBySampson(moved, estimate.inliers, estimate.cam2_from_cam1, Loss::kSquared).cam2_from_cam1;
    };
    estimate.cam2_from_cam1 = refit(0.0);
    const Vector5d moved = LocalCoordinates(refit(-error), refit(error)) / 2.0;
    CameraNoise noise;
    noise.sigma_px = {problem.sigma_px, 0.0};
    noise.camera = problem.camera1;
    noise.corrections = {{static_cast<size_t>(fault), {}, 0.0, error}};
    noise.uncertainty_correlations = {1.0};
    estimate.pose_cov.setZero();
    estimate.calibration_error_probability = 0.0;
    WidenCovariance(problem, noise, false, &estimate);
    const Matrix5d expected = moved * moved.transpose();
    EXPECT_LT((estimate.pose_cov - expected).norm(), 0.02 * expected.norm()) << FindFaultText(fault).name;
  }
}

// Of another camera than the file's nothing is known: not widened by what is uncertain of that one.
TEST(WidenCovariance, LeavesOtherCamerasTheirCovariance) {
  const MotionProblem problem = TakePairs(1).set.pairs[4].problem;
  RandomStream rng({.seed = 1, .purpose = 124});
  const MotionEstimate given = MakeEstimator("rcme_calibrated")->Estimate(problem, rng);
  CameraNoise noise;
  noise.sigma_px = {problem.sigma_px, 0.01};
  noise.corrections = {{0, {}, 0.0, 0.01}};
  noise.uncertainty_correlations = {1.0};
  const auto widen = [&](double fx) {
    noise.camera = problem.camera1;
    noise.camera.fx = fx;
    MotionEstimate widened = given;
    WidenCovariance(problem, noise, false, &widened);
    return widened.pose_cov;
  };
  EXPECT_EQ(widen(1.01 * problem.camera1.fx), given.pose_cov);
  EXPECT_GT(widen(problem.camera1.fx).trace(), 1.1 * given.pose_cov.trace());
}

// What errors of the calibration add is neither lost nor multiplied with the noise.
TEST(WidenCovariance, WidensTheLawsWithAndWithoutUnstatedErrors) {
  const MotionProblem problem = TakePairs(1).set.pairs[4].problem;
  RandomStream rng({.seed = 1, .purpose = 124});
  MotionEstimate exact = MakeEstimator("rcme_calibrated")->Estimate(problem, rng);
  exact.calibration_error_probability = 0.0;
  MotionEstimate mixture = exact;
  const Matrix5d of_errors = 9.0 * exact.pose_cov;
  mixture.calibration_error_probability = 0.25;
  mixture.pose_cov_without_errors = exact.pose_cov;
  mixture.pose_cov_with_errors = exact.pose_cov + of_errors;
  MixErrors(&mixture);
  CameraNoise noise;
  noise.sigma_px = {problem.sigma_px, 0.01};
  noise.camera = problem.camera1;
  noise.corrections = {{0, {}, 0.0, 0.01}};
  noise.uncertainty_correlations = {1.0};
  noise.displacement_px = {0.7 * problem.sigma_px, 0.01};
  noise.reach_px = 150.0;
  for (const bool is_robust : {false, true}) {
    MotionEstimate of_exact = exact, of_mixture = mixture;
    WidenCovariance(problem, noise, is_robust, &of_exact);
    WidenCovariance(problem, noise, is_robust, &of_mixture);
    EXPECT_GT(of_exact.pose_cov.trace(), 1.1 * exact.pose_cov.trace());
    EXPECT_EQ(CovarianceWithoutErrors(of_mixture), of_exact.pose_cov) << is_robust;
    EXPECT_TRUE(of_mixture.pose_cov_with_errors.isApprox(of_exact.pose_cov + of_errors, 1e-9)) << is_robust;
    EXPECT_TRUE(of_mixture.pose_cov.isApprox(of_exact.pose_cov + 0.25 * of_errors, 1e-9)) << is_robust;
  }
}

// A field that was not found and is to be expected counts as one of its variance that was.
TEST(WidenCovariance, ExpectsAFieldThatIsNotSeen) {
  const MotionProblem problem = TakePairs(1).set.pairs[4].problem;
  RandomStream rng({.seed = 1, .purpose = 124});
  const MotionEstimate given = MakeEstimator("rcme_calibrated")->Estimate(problem, rng);
  const auto widen = [&](const CameraNoise& noise) {
    MotionEstimate widened = given;
    WidenCovariance(problem, noise, false, &widened);
    return widened.pose_cov;
  };
  CameraNoise unseen, found;
  unseen.sigma_px = found.sigma_px = {problem.sigma_px, 0.01};
  unseen.unseen_px = found.displacement_px.value = 0.7 * problem.sigma_px;
  unseen.unseen_reach_px = found.reach_px = 150.0;
  EXPECT_EQ(widen(unseen), widen(found));
  EXPECT_GT(widen(unseen).trace(), 1.1 * given.pose_cov.trace());
  EXPECT_EQ(unseen.DisplacementShare(), 0.0);  // not drawn
}

// What neighbours of the pair share can be more than the file knows: a robust covariance becomes that of the
// file only where it is wider.
TEST(WidenCovariance, NeverNarrowsARobustCovariance) {
  const MotionProblem problem = TakePairs(1).set.pairs[4].problem;
  RandomStream rng({.seed = 1, .purpose = 124});
  const MotionEstimate given = MakeEstimator("rcme_calibrated")->Estimate(problem, rng);
  MotionEstimate robust = given;
  robust.calibration_error_probability = 0.0;
  MakeCovarianceRobust(problem, {}, std::nullopt, &robust);
  robust.pose_cov *= 1.1;
  CameraNoise noise;
  noise.sigma_px = {problem.sigma_px, 0.01};
  const auto widen = [&](double share, double reach_px) {
    noise.displacement_px = {std::sqrt(share) * problem.sigma_px, 0.01};
    noise.reach_px = reach_px;
    MotionEstimate widened = robust;
    WidenCovariance(problem, noise, true, &widened);
    return widened.pose_cov;
  };
  EXPECT_EQ(widen(0.0, 0.0), robust.pose_cov);
  EXPECT_EQ(widen(1e-4, 80.0), robust.pose_cov);
  EXPECT_GT(widen(0.5, 150.0).trace(), 1.1 * robust.pose_cov.trace());
}

TEST(ApplyNoise, RefusesAnotherCameraWhereItRemovesSomething) {
  MotionProblem problem = TakePairs(1).set.pairs[0].problem;
  CameraNoise noise;
  noise.sigma_px = {0.3, 0.01};
  noise.camera = problem.camera1;
  noise.corrections = {{0, {0.01, 0.001}, 0.01, 0.001}};
  EXPECT_NEAR(ApplyNoise(problem, noise, "a.csv").camera2.fx, problem.camera2.fx / 1.01, 1e-9);
  problem.camera2.fx *= 1.01;
  EXPECT_TRUE(
      ThrowsInputError([&] { ApplyNoise(problem, noise, "a.csv"); }, {"a.csv", "camera", "noise file"}));
  noise.corrections.clear();
  EXPECT_EQ(ApplyNoise(problem, noise, "a.csv").sigma_px, 0.3);
}

TEST(ReadNoiseToApply, RefusesMoreThanACameraMayHave) {
  const TempFolder folder;
  CameraNoise noise;
  noise.num_pairs = 5;
  noise.num_matches = 500;
  noise.estimator = "rcme";
  noise.camera = {700.0, 700.0, 319.5, 239.5, 640, 480};
  noise.sigma_px = {0.3, 0.01};
  noise.correlations = noise.uncertainty_correlations = {1.0};
  const auto write = [&](CameraFault fault, double removed) {
    noise.corrections = {{static_cast<size_t>(fault), {removed, 0.1}, removed, 0.1}};
    return folder.Write("noise.yaml", CameraNoiseAsYaml(noise));
  };
  EXPECT_EQ(ReadNoiseToApply(write(CameraFault::kFocalLength, -0.5)).corrections[0].removed, -0.5);
  EXPECT_TRUE(ThrowsInputError([&] { ReadNoiseToApply(write(CameraFault::kFocalLength, -1.0)); },
                               {"noise.yaml", "focal_length", "removed -1", "at most 0.5"}));
  EXPECT_TRUE(ThrowsInputError([&] { ReadNoiseToApply(write(CameraFault::kPrincipalPointX, 161.0)); },
                               {"principal_point_x", "at most 160"}));
}

// Twins with the field of the noise: halves differ in them as they do in the pairs, and the covariances that
// know it hold in both. With independent noise in the twins their halves differ less than the pairs' do.
TEST(Validate, TwinsDrawTheFieldOfTheNoise) {
  const TakenPairs taken = TakePairs(2, {{"noise", "displacement_field"},
                                         {"displacement_share", "0.3"},
                                         {"displacement_reach_px", "80"},
                                         {"outlier_ratio", "0"}});
  CameraNoise noise;
  noise.sigma_px = {0.2, 0.001};
  noise.displacement_px = {0.2 * std::sqrt(0.3), 0.001};
  noise.reach_px = 80.0;
  const auto estimator = WithSharedNoise(MakeEstimator("rcme_calibrated"), noise, false);
  const auto validate = [&](const TwinField& field) {
    const SetReport report = Validate(taken.set, *estimator, {1, 3, 0, field});
    return *std::ranges::find(report.tests, std::string("spatial_halves"), &TruthFreeTest::name);
  };
  const TruthFreeTest with = validate({noise.DisplacementShare(), noise.reach_px}), without = validate({});
  EXPECT_TRUE(with.against_twins.interval.Contains(1.0)) << with.against_twins.value;
  EXPECT_GT(without.against_twins.interval.lower, 1.0);
  EXPECT_GT(without.against_twins.value, 1.3 * with.against_twins.value);
}

TEST(CalibrateNoise, LeavesOtherCamerasOutAndRefusesTooFewPairs) {
  TakenPairs taken = TakePairs(5);
  for (size_t i = 2; i < 5; ++i) taken.set.pairs[i].problem.camera2.fx *= 1.2;
  const NoiseCalibration found = CalibrateTaken(taken, 5);
  EXPECT_EQ(found.num_other_cameras, 3);
  EXPECT_EQ(found.noise.num_pairs, 17);
  const CommandResult result = MakeNoiseCalibrationResult(found, "a");
  EXPECT_THAT(result.json, HasSubstr("rcme noise calibration 1"));
  EXPECT_THAT(RenderResult(result, "csv"), HasSubstr("\nsigma_px,0."));
  taken.set.pairs.resize(7);
  EXPECT_TRUE(ThrowsInputError([&] { CalibrateTaken(taken, 5); }, {"4 of 7 pairs", "takes 5"}));
}

}  // namespace
}  // namespace rcme
