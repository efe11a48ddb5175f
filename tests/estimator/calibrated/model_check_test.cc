// The quantities of the check on matches whose answer is known.
#include "estimator/calibrated/model_check.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/calibrated/checked_probability.h"
#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

ModelCheck CheckFittedMode(const FittedMode& f) {
  const std::vector<ExplainedMode> modes = {{f.mode, Explain(f.matches, f.mode)}};
  ModeWeights weights;
  weights.of_modes = {1.0};
  weights.is_rival = weights.is_second_motion = {false};
  return CheckModel(f.problem, modes, weights);
}

MotionProblem Changed(const FittedMode& f, auto change) {
  MotionProblem problem = f.problem;
  for (size_t i = 0; i < problem.matches.size(); ++i) change(i, &problem.matches[i]);
  return problem;
}

// Over 200 scenes: variance 2 to 3 (each other's nearest neighbours count twice, and the scale of Student's
// law is less than the residuals' standard deviation), so that the mean misses five standard deviations of
// it, by the greater variance, once in a million runs; the variance has a standard error of a tenth of it.
TEST(ModelCheckOf, NeighboursOfIndependentNoiseAgreeByChance) {
  constexpr int kScenes = 200;
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t trial = 0; trial < kScenes; ++trial) {
    const ModelCheck check = CheckFittedMode(FitScene(200, 0.5, 0.2, trial));
    sum += check.neighbour_z;
    squares += check.neighbour_z * check.neighbour_z;
  }
  EXPECT_NEAR(sum / kScenes, 0.0, 5.0 * std::sqrt(3.0 / kScenes));
  EXPECT_GT(squares / kScenes, 1.0);
  EXPECT_LT(squares / kScenes, 4.5);
}

// Errors that vary smoothly over the image, up to 3 sigma, beside independent ones of one sigma. In the mean
// over twenty scenes, whose standard deviation is a quarter of that of one.
TEST(ModelCheckOf, NeighboursThatErrAlikeAreSeen) {
  constexpr int kScenes = 20;
  double z = 0.0, design = 0.0;
  for (std::uint32_t trial = 0; trial < kScenes; ++trial) {
    const FittedMode f = FitScene(200, 0.5, 0.0, trial);
    const MotionProblem wavy = Changed(f, [](size_t, Correspondence* match) {
      const Eigen::Vector2d x = match->x1_px / 80.0;
      match->x2_px +=
          1.5 * Eigen::Vector2d(std::cos(x.x()) * std::sin(x.y()), std::sin(x.x()) * std::cos(x.y()));
    });
    const ModelCheck check = CheckFittedMode(FitFromTruth(wavy, f.pose_true));
    z += check.neighbour_z / kScenes;
    design += check.log_design_4 / kScenes;
  }
  EXPECT_GT(z, 4.0);
  EXPECT_GT(design, 0.3);
}

TEST(ModelCheckOf, TheNoiseThatIsFoundIsComparedWithTheAssumed) {
  for (const double factor : {0.5, 1.0, 2.0}) {
    const ModelCheck check = CheckFittedMode(FitScene(400, 0.5, 0.2, 3, factor));
    EXPECT_NEAR(check.log_noise_ratio, -std::log(factor), 0.15) << factor;
  }
}

// The points of a scene moved onto a plane, the same cameras.
FittedMode FitPlane(std::uint32_t trial) {
  const Scene scene = TwoCameraScene(200, trial);
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2901});
  MotionProblem problem{{}, scene.camera1, scene.camera2, 0.5};
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.3, 1.0).normalized();
  for (const Eigen::Vector3d& point : scene.points_in_cam1) {
    const Eigen::Vector3d moved = point * (3.0 / normal.dot(point));
    problem.matches.push_back(ProjectToBoth(moved,
                                            {scene.cam2_from_cam1_true.R, 0.5 * scene.cam2_from_cam1_true.t},
                                            scene.camera1, scene.camera2));
  }
  AddNoise(0.5, rng, &problem);
  return FitFromTruth(problem, scene.cam2_from_cam1_true);
}

TEST(ModelCheckOf, APlaneExplainsThePointsOfAPlaneAlone) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    EXPECT_GT(CheckFittedMode(FitPlane(trial)).planar_share, 0.95) << trial;
    EXPECT_LT(CheckFittedMode(FitScene(200, 0.5, 0.0, trial)).planar_share, 0.6) << trial;
  }
}

TEST(ModelCheckOf, WrongMatchesThatMoveTogetherAreToldFromOthers) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const FittedMode f = FitScene(200, 0.5, 0.3, trial);
    const Explanation explanation = Explain(f.matches, f.mode);
    const ModelCheck scattered = CheckFittedMode(f);
    EXPECT_LT(scattered.wrong_coherence, 0.3) << trial;
    // Wrong matches that are all displaced by the same.
    const MotionProblem together = Changed(f, [&](size_t i, Correspondence* match) {
      if (explanation.probability[i] <= 0.5) match->x2_px = match->x1_px + Eigen::Vector2d(25.0, -60.0);
    });
    const ModelCheck check = CheckFittedMode(FitFromTruth(together, f.pose_true));
    EXPECT_GT(check.wrong_coherence, 0.9) << trial;
    EXPECT_GT(check.wrong_share, 0.15) << trial;
    EXPECT_LT(check.wrong_share, 0.35) << trial;
  }
}

// All matches right: the right ones are spread as all are.
TEST(ModelCheckOf, SpreadIsOfTheRightMatches) {
  const FittedMode f = FitScene(300, 0.5, 0.0, 4);
  FittedMode all = f;
  const Explanation explanation = Explain(all.matches, all.mode);
  double num_right = 0.0;
  for (const double p : explanation.probability) num_right += p > 0.5;
  const ModelCheck check = CheckFittedMode(f);
  EXPECT_NEAR(check.spread_in_matches, 0.0, 0.02);
  EXPECT_NEAR(check.wrong_share, 1.0 - num_right / 300.0, 1e-12);
}

// Points of one corner three baselines away, the others three thousand: a sixteenth of the image or two.
FittedMode FitNearCorner(std::uint32_t trial) {
  const Scene scene = TwoCameraScene(300, trial);
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2902});
  MotionProblem problem{{}, scene.camera1, scene.camera2, 0.3};
  for (const Eigen::Vector3d& point : scene.points_in_cam1) {
    const Eigen::Vector2d x = scene.camera1.Project(point);
    const bool is_near = x.x() < 0.25 * scene.camera1.width && x.y() < 0.25 * scene.camera1.height;
    problem.matches.push_back(ProjectToBoth(point * ((is_near ? 3.0 : 3000.0) / point.z()),
                                            scene.cam2_from_cam1_true, scene.camera1, scene.camera2));
  }
  AddNoise(0.3, rng, &problem);
  return FitFromTruth(problem, scene.cam2_from_cam1_true);
}

TEST(ModelCheckOf, ParallaxOfACornerIsTold) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const ModelCheck of_corner = CheckFittedMode(FitNearCorner(trial));
    EXPECT_LT(of_corner.log_parallax_share, std::log(0.3)) << trial;
    EXPECT_LT(of_corner.parallax_spread, std::log(0.4)) << trial;
    const ModelCheck of_all = CheckFittedMode(FitScene(300, 0.3, 0.0, trial));
    EXPECT_GT(of_all.log_parallax_share, std::log(0.4)) << trial;
    EXPECT_GT(of_all.parallax_spread, std::log(0.7)) << trial;
    EXPECT_NEAR(of_all.near_in_right, 0.0, 0.1) << trial;
  }
}

// det of the covariance of points (x, y in px, weight), px^4.
double AreaSquared(const std::vector<Eigen::Vector3d>& x_y_weight) {
  double sum = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Eigen::Vector3d& a : x_y_weight) {
    sum += a.z();
    for (const Eigen::Vector3d& b : x_y_weight) {  // pairs: no mean is needed
      const Eigen::Vector3d d = a - b;
      const double w = 0.5 * a.z() * b.z();
      xx += w * d.x() * d.x();
      xy += w * d.x() * d.y();
      yy += w * d.y() * d.y();
    }
  }
  return (xx * yy - xy * xy) / std::pow(sum, 4);
}

TEST(ModelCheckOf, NearMatchesAreThoseWithParallaxOfThreeStandardDeviations) {
  int num_within = 0;  // the bound
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const FittedMode f = FitNearCorner(trial);
    const Explanation explained = Explain(f.matches, f.mode);
    std::vector<Eigen::Vector3d> right, near, weighted;
    for (size_t i = 0; i < f.problem.matches.size(); ++i) {
      if (explained.probability[i] <= 0.5) continue;
      const Eigen::Vector2d& x = f.problem.matches[i].x1_px;
      const double z = explained.terms.depth[i];
      right.emplace_back(x.x(), x.y(), 1.0);
      if (z < 3.0 * f.mode.mixture.scale) continue;
      near.emplace_back(x.x(), x.y(), 1.0);
      weighted.emplace_back(x.x(), x.y(), z * z);
    }
    ASSERT_LT(near.size(), right.size());
    const auto expected = [&](const std::vector<Eigen::Vector3d>& some) {
      return std::max(-2.0, 0.25 * std::log(AreaSquared(some) / AreaSquared(right)));
    };
    num_within += expected(weighted) > -2.0;
    const ModelCheck check = CheckFittedMode(f);
    EXPECT_NEAR(check.near_in_right, expected(near), 1e-6) << trial;
    EXPECT_NEAR(check.parallax_spread, expected(weighted), 1e-6) << trial;
  }
  EXPECT_GT(num_within, 10);
}

// Sixty of two hundred matches have the second point that the opposite translation would give.
TEST(ModelCheckOf, MatchesBehindTheCamerasAreTold) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const Scene scene = TwoCameraScene(200, trial);
    const RelativePose& pose = scene.cam2_from_cam1_true;
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2903});
    MotionProblem problem{{}, scene.camera1, scene.camera2, 0.3};
    for (const Eigen::Vector3d& point : scene.points_in_cam1) {
      const double way = problem.matches.size() < 60 ? -1.0 : 1.0;
      problem.matches.push_back(ProjectToBoth(point, {pose.R, way * pose.t}, scene.camera1, scene.camera2));
    }
    AddNoise(0.3, rng, &problem);
    EXPECT_NEAR(CheckFittedMode(FitFromTruth(problem, pose)).log_behind, std::log(60.0 / 140.0), 0.2)
        << trial;
    EXPECT_LT(CheckFittedMode(FitScene(200, 0.3, 0.2, trial)).log_behind, std::log(0.05)) << trial;
  }
}

TEST(ModelCheckOf, TheGreatestRivalIsTold) {
  const FittedMode f = FitScene(100, 0.5, 0.0, 5);
  const Explanation explanation = Explain(f.matches, f.mode);
  const std::vector<ExplainedMode> modes(9, {f.mode, explanation});
  ModeWeights weights;
  weights.answer = 1;
  weights.of_modes = {0.1, 0.3, 0.2, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05};
  weights.is_rival = {true, false, true, true, true, true, true, true, true};
  EXPECT_DOUBLE_EQ(CheckModel(f.problem, modes, weights).greatest_rival, 0.2);
  weights.is_rival.assign(9, false);
  EXPECT_DOUBLE_EQ(CheckModel(f.problem, modes, weights).greatest_rival, 0.0);
}

// By hand: of the right matches of a mode the mean of p, that of ln(density / density of a wrong match), and
// the greatest leverage; of its covariance the standard deviations.
TEST(ModelCheckOf, WhatRightMatchesSayIsTold) {
  const FittedMode f = FitScene(200, 0.5, 0.2, 7);
  const Explanation e = Explain(f.matches, f.mode);
  double num_right = 0.0, probability = 0.0, log_ratio = 0.0, leverage = 0.0;
  for (size_t i = 0; i < e.probability.size(); ++i) {
    if (e.probability[i] <= 0.5) continue;
    num_right += 1.0;
    probability += e.probability[i];
    log_ratio += std::log(e.inlier_density[i]) - std::log(f.mode.mixture.outlier_density);
    leverage = std::max(leverage, e.leverage[i]);
  }
  const ModelCheck check = CheckFittedMode(f);
  EXPECT_NEAR(check.log_num_right, std::log(num_right), 1e-12);
  EXPECT_NEAR(check.mean_probability, probability / num_right, 1e-12);
  EXPECT_NEAR(check.mean_gain, log_ratio / num_right, 1e-9);
  EXPECT_GT(check.mean_gain, 1.0);
  EXPECT_DOUBLE_EQ(check.greatest_leverage, leverage);
  const Matrix5d& C = f.mode.inverse_hessian;
  EXPECT_NEAR(check.log_rotation_sd, 0.5 * std::log(C(0, 0) + C(1, 1) + C(2, 2)), 1e-12);
}

// Every match the same one, and a handful.
TEST(ModelCheckOf, IsFiniteWhateverTheMatches) {
  for (const int n : {6, 8, 12}) {
    for (const bool is_one : {false, true}) {
      FittedMode f = FitScene(n, 0.5, 0.0, 6);
      if (is_one) {
        MotionProblem same = f.problem;
        std::ranges::fill(same.matches, same.matches.front());
        f = FitFromTruth(same, f.pose_true);
      }
      const ModelCheck c = CheckFittedMode(f);
      for (const FitTerm& sign : ListCheckSigns(c)) EXPECT_TRUE(std::isfinite(sign.value)) << n << sign.name;
      EXPECT_TRUE(std::isfinite(c.wrong_share + c.usual_depth + c.partner_dependence.order_z)) << n << is_one;
    }
  }
}

}  // namespace
}  // namespace rcme
