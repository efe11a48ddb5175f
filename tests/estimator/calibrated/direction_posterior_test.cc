#include "estimator/calibrated/direction_posterior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "estimator/calibrated/direction_axis.h"
#include "estimator/geometry/sampson.h"
#include "stats/constants.h"
#include "stats/intervals.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

constexpr double kSigmaPx = 0.5;

// Noisy matches of points whose displacement by the translation is about `parallax_px`, and a mode that
// explains all of them: the true rotation, no outliers.
struct ParallaxCase {
  RandomProblem random;
  ExplainedMode mode;
};
ExplainedMode ExplainAll(const MotionProblem& problem, const RelativePose& pose) {
  const MatchBlocks matches(problem);
  ExplainedMode explained;
  explained.mode.pose = pose;
  explained.mode.mixture.scale = explained.mode.mixture.noise.scale_of_gaussian;
  explained.mode.used = matches.All();
  explained.explanation = Explain(matches, explained.mode);
  explained.explanation.probability.assign(problem.matches.size(), 1.0);
  return explained;
}
ParallaxCase MakeParallax(std::uint32_t trial, int num_matches, double parallax_px) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2790});
  ParallaxCase c;
  c.random = MakeRandomProblem(rng, {.num_matches = num_matches});
  c.random.pose_true.t = RandomDirection(rng);
  MotionProblem& problem = c.random.problem;
  const double mean_inverse_depth = parallax_px / problem.camera1.fx;
  for (size_t i = 0; i < problem.matches.size(); ++i) {
    const Eigen::Vector3d ray = c.random.points_in_cam1[i] / c.random.points_in_cam1[i].z();
    const double inverse_depth = std::max(mean_inverse_depth * rng.Uniform(0.3, 1.7), 1e-9);
    problem.matches[i] =
        ProjectToBoth(ray / inverse_depth, c.random.pose_true, problem.camera1, problem.camera2);
  }
  AddNoise(kSigmaPx, rng, &problem);
  problem.sigma_px = kSigmaPx;
  c.mode = ExplainAll(problem, c.random.pose_true);
  return c;
}

// Eight directions, none near another: the corners of a cube.
std::vector<Eigen::Vector3d> Corners() {
  std::vector<Eigen::Vector3d> corners;
  for (int k = 0; k < 8; ++k)
    corners.push_back(Eigen::Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1).normalized());
  return corners;
}

// The image covers width / fx by height / fy: with fx = 400 and fy = 1600 px, 1.6 by 0.3 rad. A mean of the
// two focal lengths gives another area.
TEST(CollectDisplacements, TheImageIsMeasuredByBothFocalLengths) {
  ParallaxCase c = MakeParallax(0, 20, 30.0);
  Camera& camera2 = c.random.problem.camera2;
  camera2.fx = 400.0, camera2.fy = 1600.0, camera2.width = 640, camera2.height = 480;
  EXPECT_NEAR(CollectDisplacements(c.random.problem, c.mode).image_rad, std::sqrt(1.6 * 0.3), 1e-12);
}

TEST(PosteriorOfDirection, IsOneAboutTheDirectionOfAClearParallax) {
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const ParallaxCase c = MakeParallax(trial, 80, 20.0);
    const Eigen::Vector3d t = c.random.pose_true.t;
    EXPECT_GT(PosteriorOfDirection(c.random.problem, c.mode, t, 15.0 * kRadPerDeg).mass_within, 0.99)
        << trial;
    EXPECT_LT(PosteriorOfDirection(c.random.problem, c.mode, -t, 90.0 * kRadPerDeg).mass_within, 1e-3)
        << trial;
    EXPECT_NEAR(PosteriorOfDirection(c.random.problem, c.mode, -t, 170.0 * kRadPerDeg).mass_within,
                1.0 - PosteriorOfDirection(c.random.problem, c.mode, t, 10.0 * kRadPerDeg).mass_within, 0.02)
        << trial;
  }
}

// The masses about the corners of a cube, each within 35 deg, are of disjoint parts of the sphere.
TEST(PosteriorOfDirection, OfDisjointPartsAddsUpToLessThanOne) {
  for (const double parallax_px : {0.0, 0.5, 2.0}) {
    const ParallaxCase c = MakeParallax(3, 60, parallax_px);
    double sum = 0.0;
    for (const Eigen::Vector3d& corner : Corners())
      sum += PosteriorOfDirection(c.random.problem, c.mode, corner, 35.0 * kRadPerDeg).mass_within;
    EXPECT_LT(sum, 1.1) << parallax_px;
    // They are .72 of the sphere, which is alike everywhere if there is no parallax.
    if (parallax_px == 0.0) {
      EXPECT_GT(sum, 0.5);
    }
  }
}

// Of the corners the one with the greatest mass is taken, from no parallax to some: it is within 35 deg of
// the truth as often as stated. 240 trials: a standard error of three points; the stated mean must lie within
// the exact 99 % interval of the rate, which a mass twice too certain leaves.
TEST(PosteriorOfDirection, IsAsOftenRightAsStated) {
  for (const double parallax_px : {0.2, 0.6, 1.2}) {
    constexpr int kTrials = 240;
    int num_right = 0;
    double stated = 0.0;
    for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
      const ParallaxCase c = MakeParallax(100 + trial, 60, parallax_px);
      double greatest = -1.0;
      Eigen::Vector3d best;
      for (const Eigen::Vector3d& corner : Corners()) {
        const double mass =
            PosteriorOfDirection(c.random.problem, c.mode, corner, 35.0 * kRadPerDeg).mass_within;
        if (mass > greatest) greatest = mass, best = corner;
      }
      stated += greatest / kTrials;
      num_right += AngleBetween(best, c.random.pose_true.t) <= 35.0 * kRadPerDeg;
    }
    const Interval rate = ExactBinomialInterval(num_right, kTrials, 0.99);
    EXPECT_GE(stated, rate.lower) << parallax_px << " px: right " << num_right;
    EXPECT_LE(stated, rate.upper) << parallax_px << " px: right " << num_right;
  }
}

// Without parallax every direction is as likely: those within 90 deg of any centre have a mean squared angle
// of pi - 2, half of it along each coordinate.
TEST(PosteriorOfDirection, HasTheSpreadOfHalfASphereWithoutParallax) {
  double sum = 0.0;
  constexpr int kTrials = 40;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    const ParallaxCase c = MakeParallax(trial, 100, 0.0);
    const Matrix5d covariance =
        PosteriorOfDirection(c.random.problem, c.mode, c.random.pose_true.t, RadFromDeg(15.0)).covariance;
    sum += covariance.bottomRightCorner<2, 2>().trace() / kTrials;
    EXPECT_LT(std::sqrt(covariance.topLeftCorner<3, 3>().trace()), RadFromDeg(2.0)) << trial;
  }
  EXPECT_NEAR(sum, std::numbers::pi - 2.0, 0.12);
}

// About a direction that is independent of the true one, the mean of (probability of the half sphere) times
// (second moment in it) is that of the squared angle of the truths in it, as the law of total expectation
// says. The difference has a standard error from the trials themselves, of which four are allowed: one false
// alarm in 16,000. A covariance twice too small is more than eight of them away.
TEST(PosteriorOfDirection, HasTheSecondMomentOfTheTruths) {
  double sum = 0.0, sum_squares = 0.0, sum_truths = 0.0;
  constexpr int kTrials = 1000;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    const ParallaxCase c = MakeParallax(trial, 60, 1.0);
    const Eigen::Vector3d centre = Eigen::Vector3d(1.0, 2.0, 3.0).normalized();
    const DirectionPosterior posterior =
        PosteriorOfDirection(c.random.problem, c.mode, centre, 0.5 * std::numbers::pi);
    const double angle = AngleBetween(centre, c.random.pose_true.t);
    const double of_truth = angle < 0.5 * std::numbers::pi ? angle * angle : 0.0;
    const double difference =
        posterior.mass_within * posterior.covariance.bottomRightCorner<2, 2>().trace() - of_truth;
    sum += difference, sum_squares += difference * difference, sum_truths += of_truth;
  }
  const double standard_error = std::sqrt(sum_squares) / kTrials;
  EXPECT_LT(std::abs(sum) / kTrials, 4.0 * standard_error) << sum / kTrials << " +- " << standard_error;
  EXPECT_GT(0.5 * sum_truths / kTrials, 8.0 * standard_error) << sum_truths / kTrials;  // the power
}

// The mass within 30 deg of the centre or of the most likely direction: their sum if they are far apart, up
// to the size of the cells, and that of one if they coincide.
TEST(PosteriorOfDirection, MassOfBothIsThatOfTheUnion) {
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const ParallaxCase c = MakeParallax(trial, 150, 2.0);
    const double angle = 30.0 * kRadPerDeg;
    const auto about = [&](const Eigen::Vector3d& centre) {
      return PosteriorOfDirection(c.random.problem, c.mode, centre, angle);
    };
    const Eigen::Vector3d best = about(c.random.pose_true.t).best.pose.t;
    const DirectionPosterior at_best = about(best), across = about(best.unitOrthogonal());
    EXPECT_NEAR(across.mass_of_both, across.mass_within + at_best.mass_within, 0.35) << trial;
    EXPECT_NEAR(at_best.mass_of_both, at_best.mass_within, 0.2) << trial;
    EXPECT_GE(at_best.mass_of_both, at_best.mass_within) << trial;
  }
}

// Pixels four times as long as high make the noise of rays so, too. Without parallax no direction is more
// likely than another; a law of isotropic noise would have nearly all mass along the greater noise.
TEST(PosteriorOfDirection, LongPixelsAreNoParallax) {
  double along = 0.0, across = 0.0;
  constexpr int kTrials = 20;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2793});
    MotionProblem problem;
    problem.camera1 = problem.camera2 = {400.0, 1600.0, 320.0, 240.0, 640, 480};
    problem.sigma_px = kSigmaPx;
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d x(rng.Uniform(0.0, 640.0), rng.Uniform(0.0, 480.0));
      problem.matches.push_back({x, x});
    }
    AddNoise(kSigmaPx, rng, &problem);
    const ExplainedMode mode = ExplainAll(problem, {Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitX()});
    const auto mass = [&](const Eigen::Vector3d& t) {
      return PosteriorOfDirection(problem, mode, t, 35.0 * kRadPerDeg).mass_within +
             PosteriorOfDirection(problem, mode, -t, 35.0 * kRadPerDeg).mass_within;
    };
    along += mass(Eigen::Vector3d::UnitX()) / kTrials;
    across += mass(Eigen::Vector3d::UnitY()) / kTrials;
  }
  EXPECT_LT(along, 0.5);
  EXPECT_GT(across, 0.05);
}

// A fifth of the explained matches exceeds it: rank floor(0.8 n) of n.

TEST(UsualDepthInNoise, IsExceededByAFifthOfTheExplained) {
  Explanation explanation;
  EXPECT_EQ(UsualDepthInNoise(explanation), 0.0);
  for (int i = 0; i < 10; ++i) {
    explanation.probability.push_back(0.9);
    explanation.terms.depth.push_back(i);
    explanation.probability.push_back(0.4);
    explanation.terms.depth.push_back(1000.0);
  }
  EXPECT_EQ(UsualDepthInNoise(explanation), 8.0);
}

// The noise is that of Gaussian noise which the law's scale stands for: either law, at the scale that it
// finds in the same noise, gives the same. (Residuals of zero, so that either weighs all matches fully.)
TEST(PosteriorOfDirection, HasTheNoiseWhateverTheLaw) {
  ParallaxCase c = MakeParallax(11, 80, 0.8);
  c.mode.explanation.terms.residual.assign(c.mode.explanation.terms.residual.size(), 0.0);
  const auto mass = [&](const NoiseLaw& law) {
    c.mode.mode.mixture.noise = law;
    c.mode.mode.mixture.scale = law.scale_of_gaussian;
    return PosteriorOfDirection(c.random.problem, c.mode, c.random.pose_true.t, 30.0 * kRadPerDeg)
        .mass_within;
  };
  ASSERT_GT(mass(NoiseLaw()), 0.01);
  ASSERT_LT(mass(NoiseLaw()), 0.99);
  EXPECT_NEAR(mass(NoiseLaw()), mass(kStudent15), 1e-9);
}

// Of matches that the mode is said to explain, one in eight is displaced by 40 px across its epipolar line:
// none of these is used at the best direction, and nearly all of the others are.
TEST(PosteriorOfDirection, LeavesOutWhatIsWrongThere) {
  ParallaxCase c = MakeParallax(7, 80, 4.0);
  MotionProblem& problem = c.random.problem;
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(c.random.pose_true), problem.camera1, problem.camera2);
  for (size_t i = 0; i < 80; i += 8) {
    const Eigen::Vector4d gradient = EvaluateConstraint(F, problem.matches[i]).gradient;
    problem.matches[i].x2_px += 40.0 * gradient.tail<2>().normalized();
  }
  c.mode.explanation.terms.residual.assign(c.mode.explanation.terms.residual.size(), 0.0);
  const DirectionPosterior posterior =
      PosteriorOfDirection(problem, c.mode, c.random.pose_true.t, 15.0 * kRadPerDeg);
  int num_wrong_used = 0, num_right_used = 0;
  for (size_t i = 0; i < 80; ++i) {
    const bool is_used = posterior.best.used[i / kBlockSize] >> (i % kBlockSize) & 1;
    (i % 8 == 0 ? num_wrong_used : num_right_used) += is_used;
  }
  EXPECT_EQ(num_wrong_used, 0);
  EXPECT_GE(num_right_used, 65);
}

// The matches that are looked at stand for all that the mode explains: 60 of 120 say what the 120 say of
// which each is there twice, and more than 60 of 60.
TEST(PosteriorOfDirection, StandsForAllThatTheModeExplains) {
  double sum_apart = 0.0;
  for (std::uint32_t trial = 0; trial < 4; ++trial) {
    const ParallaxCase c = MakeParallax(20 + trial, 60, 0.6);
    const auto mass = [&](const MotionProblem& problem, ExplainedMode mode, int num_explained) {
      mode.explanation.num_explained = num_explained;
      return PosteriorOfDirection(problem, mode, c.random.pose_true.t, 30.0 * kRadPerDeg).mass_within;
    };
    MotionProblem twice = c.random.problem;
    for (const Correspondence& match : c.random.problem.matches) twice.matches.push_back(match);
    const double of_part = mass(c.random.problem, c.mode, 120);
    EXPECT_NEAR(of_part, mass(twice, ExplainAll(twice, c.random.pose_true), 120), 1e-9) << trial;
    sum_apart += std::abs(of_part - mass(c.random.problem, c.mode, 60));
  }
  EXPECT_GT(sum_apart, 1e-3);
}

// The rotation is integrated out: from a mode that is turned about the optical axis by 12 mrad, which moves
// matches at the edge of the image by 4 px, six standard deviations of a displacement, the posterior is
// nearly the same, and no match is wrong.
TEST(PosteriorOfDirection, MakesUpForTheModesRotation) {
  for (std::uint32_t trial = 0; trial < 6; ++trial) {
    ParallaxCase c = MakeParallax(40 + trial, 80, 4.0);
    const auto posterior = [&] {
      return PosteriorOfDirection(c.random.problem, c.mode, c.random.pose_true.t, 15.0 * kRadPerDeg);
    };
    const DirectionPosterior exact = posterior();
    c.mode.mode.pose.R = RotationFromVector({0.0, 0.0, 0.012}) * c.random.pose_true.R;
    const DirectionPosterior turned = posterior();
    EXPECT_NEAR(turned.mass_within, exact.mass_within, 0.1) << trial;
    EXPECT_LT(RotationAngleBetween(turned.best.pose.R, exact.best.pose.R), 5e-3) << trial;
    EXPECT_GE(CountIn(turned.best.used), 74) << trial;
  }
}

}  // namespace
}  // namespace rcme
