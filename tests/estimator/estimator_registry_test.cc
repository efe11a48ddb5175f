// The contract of every estimator in the registry: a new one is tested by its line there.
#include "estimator/estimator_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <optional>

#include "estimator/solvers/solver_table.h"
#include "parameters/input_error.h"
#include "stats/constants.h"
#include "tests/test_support/estimator_variants.h"
#include "tests/test_support/make_ransac.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

struct Pair {
  MotionProblem problem;
  RelativePose pose_true;
};

Pair MakePair(int num_matches, double sigma_px, double outlier_ratio, std::uint32_t trial) {
  Pair pair;
  pair.problem = TwoCameraProblem(num_matches, sigma_px, outlier_ratio, trial, &pair.pose_true);
  return pair;
}

// What a variant says of an option.
std::string WordFor(const EstimatorVariant& variant, const std::string& option) {
  for (const auto& [name, word] : variant.options) {
    if (name == option) return word;
  }
  return "";
}

struct SolverFacts {
  int sample_size = 0, max_models = 0;
  bool has_fast = false;
};

// Nothing: an estimator without that option.
std::optional<SolverFacts> FindFacts(const std::string& solver_name) {
  for (const auto& [name, solver] : SolverNames()) {
    if (name != solver_name) continue;
    return VisitSolver(solver, []<typename S>(std::type_identity<S>) {
      return SolverFacts{S::kSampleSize, S::kMaxModels, kHasFast<S>};
    });
  }
  return std::nullopt;
}

// Every solver with every reading and each implementation that it has.
std::vector<EstimatorVariant> Variants() {
  std::vector<EstimatorVariant> variants;
  for (EstimatorVariant variant : EstimatorVariants({"solver", "reading", "implementation"})) {
    const std::string implementation = WordFor(variant, "implementation");
    const std::optional<SolverFacts> solver = FindFacts(WordFor(variant, "solver"));
    if (implementation == "automatic") continue;
    if (implementation == "fast" && !(solver && solver->has_fast)) continue;
    // Up to ten models a sample, one by one: fewer samples will do.
    if (implementation == "reference" && solver && solver->max_models > 1) {
      variant.options.emplace_back("num_iterations", "40");
    }
    variants.push_back(variant);
  }
  return variants;
}

class EstimatorContract : public testing::TestWithParam<EstimatorVariant> {
 protected:
  MotionEstimate Estimate(const MotionProblem& problem, std::uint32_t trial = 0) const {
    RandomStream rng({1, 0, trial, 4});
    return estimator_->Estimate(problem, rng);
  }
  static std::string Solver() { return WordFor(GetParam(), "solver"); }
  static int SampleSize() {
    if (const std::optional<SolverFacts> solver = FindFacts(Solver())) return solver->sample_size;
    return GetParam().estimator == "rcme_calibrated" ? 6 : 8;  // five decide nothing there
  }
  std::unique_ptr<MotionEstimator> estimator_ = GetParam().Make();
};

TEST_P(EstimatorContract, FindsTheMotionOfCleanMatches) {
  if (Solver() == "one_point") return;  // of a car alone: OnePointEstimators below
  for (std::uint32_t trial = 0; trial < 5; ++trial) {
    const Pair pair = MakePair(100, 0.01, 0.0, trial);
    const MotionEstimate estimate = Estimate(pair.problem);
    ASSERT_EQ(estimate.status, MotionStatus::kOk) << estimate.message;
    EXPECT_LT(RotationAngleBetween(estimate.cam2_from_cam1.R, pair.pose_true.R), 0.002);
    EXPECT_LT(AngleBetween(estimate.cam2_from_cam1.t, pair.pose_true.t), 0.02);
    EXPECT_NEAR(estimate.cam2_from_cam1.t.norm(), 1.0, 1e-12);
    EXPECT_NEAR(estimate.cam2_from_cam1.R.determinant(), 1.0, 1e-9);
    EXPECT_GT(estimate.pose_cov.determinant(), 0.0);
    EXPECT_TRUE(std::is_sorted(estimate.inliers.begin(), estimate.inliers.end()));
    EXPECT_GT(estimate.inliers.size(), 80u);
  }
}

TEST_P(EstimatorContract, IsAPureFunctionOfProblemAndStream) {
  const Pair pair = MakePair(200, 0.5, 0.2, 0);
  const MotionEstimate a = Estimate(pair.problem), b = Estimate(pair.problem);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.cam2_from_cam1.R, b.cam2_from_cam1.R);
  EXPECT_EQ(a.cam2_from_cam1.t, b.cam2_from_cam1.t);
  EXPECT_EQ(a.pose_cov, b.pose_cov);
  EXPECT_EQ(a.inliers, b.inliers);
}

TEST_P(EstimatorContract, CountsAddUp) {
  const LoopCounts c = Estimate(MakePair(100, 0.5, 0.3, 0).problem).counts;
  EXPECT_GE(c.num_hypotheses, 40);
  if (SampleSize() == 8) {
    EXPECT_EQ(c.num_hypotheses, 200);
  }
  EXPECT_EQ(c.num_degenerate_samples + c.num_inconsistent_samples + c.num_poor_inlier_sets +
                c.num_too_small_inlier_sets + c.num_candidates,
            c.num_hypotheses);
}

// What no estimator may crash, hang or throw at. Every call ends in a named status, and only kOk has inliers.
TEST_P(EstimatorContract, SurvivesHostileMatches) {
  const Pair good = MakePair(60, 0.5, 0.0, 0);
  const auto with = [&](auto change) {
    MotionProblem problem = good.problem;
    change(problem);
    return Estimate(problem).status;
  };
  EXPECT_EQ(with([](auto& p) { p.matches.clear(); }), MotionStatus::kTooFewMatches);
  const auto least = static_cast<size_t>(SampleSize());
  EXPECT_EQ(with([&](auto& p) { p.matches.resize(least - 1); }), MotionStatus::kTooFewMatches);
  EXPECT_EQ(with([](auto& p) { p.matches.assign(60, p.matches[0]); }),
            least > 1 ? MotionStatus::kTooFewMatches : MotionStatus::kDegenerateMatches);
  EXPECT_EQ(with([](auto& p) { p.matches[3].x1_px.x() = kNaN; }), MotionStatus::kInvalidInput);
  EXPECT_EQ(with([](auto& p) { p.matches[3].x2_px.y() = kInfinity; }), MotionStatus::kInvalidInput);
  EXPECT_EQ(with([](auto& p) { p.matches[3].x2_px.y() = 1e300; }), MotionStatus::kInvalidInput);
  EXPECT_EQ(with([](auto& p) { p.camera1.fx = 0.0; }), MotionStatus::kInvalidInput);
  EXPECT_EQ(with([](auto& p) { p.sigma_px = 0.0; }), MotionStatus::kInvalidInput);
  EXPECT_EQ(with([](auto& p) { p.sigma_px = kNaN; }), MotionStatus::kInvalidInput);
  EXPECT_EQ(with([](auto& p) {
              for (auto& m : p.matches) m.x1_px.y() = 2.0 * m.x1_px.x() + 3.0;
            }),
            MotionStatus::kDegenerateMatches);
  // The same image twice: no translation. Any named status will do, and no number may be bad.
  MotionProblem still = good.problem;
  for (Correspondence& match : still.matches) match.x2_px = match.x1_px;
  const MotionEstimate estimate = Estimate(still);
  EXPECT_TRUE(estimate.cam2_from_cam1.R.allFinite());
  // The least matches there may be.
  MotionProblem smallest = good.problem;
  smallest.matches.resize(least);
  EXPECT_TRUE(Estimate(smallest).cam2_from_cam1.R.allFinite());
}

// Cameras that cannot be true (the principal point far outside of the image, a focal length of one pixel or
// of a million) leave samples on the border of rounding: any answer, with finite numbers if it is a motion.
TEST_P(EstimatorContract, AnswersWhateverTheCamerasAreSaidToBe) {
  const std::uint32_t num_trials = SampleSize() == 8 ? 20 : 2;
  for (std::uint32_t trial = 0; trial < num_trials; ++trial) {
    for (const double principal_point_error_px : {-1e5, 0.0, 1e5}) {
      for (const double scale : {1.0 / 700.0, 1.0, 1e6 / 700.0}) {
        MotionProblem problem = MakePair(20, 0.5, 0.2, trial).problem;
        for (Camera* camera : {&problem.camera1, &problem.camera2}) {
          camera->cx += principal_point_error_px;
          camera->cy += principal_point_error_px;
          camera->fx *= scale;
          camera->fy *= scale;
        }
        const MotionEstimate estimate = Estimate(problem, trial);
        EXPECT_FALSE(estimate.message.empty());
        if (estimate.status != MotionStatus::kOk) continue;
        EXPECT_TRUE(estimate.cam2_from_cam1.R.allFinite() && estimate.cam2_from_cam1.t.allFinite());
        EXPECT_TRUE(estimate.pose_cov.allFinite());
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, EstimatorContract, testing::ValuesIn(Variants()),
                         [](const auto& c) { return c.param.name; });

// A car's turn of 8 deg to the right, seen through matches with noise and outliers; one_point finds it, and
// the refinement of all five degrees of freedom does no harm.
TEST(OnePointEstimators, FindTheMotionOfACar) {
  RandomStream rng({.seed = 1, .purpose = 2730});
  const double yaw = 0.14;
  Eigen::Matrix3d R;
  R << std::cos(yaw), 0.0, -std::sin(yaw), 0.0, 1.0, 0.0, std::sin(yaw), 0.0, std::cos(yaw);
  const RelativePose pose{R, -(R * Eigen::Vector3d(std::sin(0.5 * yaw), 0.0, std::cos(0.5 * yaw)))};
  MotionProblem problem{{}, TestCamera1(), TestCamera2(), 0.5};
  while (problem.matches.size() < 150) {
    const auto point = RandomPoint(pose, problem.camera1, problem.camera2, {}, rng);
    if (!point) continue;
    problem.matches.push_back(ProjectToBoth(*point, pose, problem.camera1, problem.camera2));
    AddNoise(0.5, rng, &problem.matches.back());
    if (problem.matches.size() % 3 == 0) {
      problem.matches.back().x2_px << rng.Uniform(0.0, 799.0), rng.Uniform(0.0, 599.0);
    }
  }
  for (const std::string name : {"standard", "prcme", "rcme"}) {
    for (const Refinement refinement : {Refinement::kNone, Refinement::kRobust}) {
      RansacOptions options;
      options.reading = Reading::kRankAware;
      options.solver = MinimalSolver::kOnePoint;
      options.refinement = refinement;
      RandomStream sampling({1, 0, 0, 4});
      const MotionEstimate estimate = MakeRansac(name, options)->Estimate(problem, sampling);
      ASSERT_EQ(estimate.status, MotionStatus::kOk) << name << ": " << estimate.message;
      EXPECT_LT(RotationAngleBetween(estimate.cam2_from_cam1.R, pose.R), 0.01) << name;
      EXPECT_LT(AngleBetween(estimate.cam2_from_cam1.t, pose.t), 0.05) << name;
      EXPECT_EQ(estimate.hypothesis.sample.size(), 1);
    }
  }
}

TEST(RansacOptions, FastIsRefusedWhereThereIsNone) {
  RansacOptions options;
  options.solver = MinimalSolver::kSevenPoint;
  EXPECT_NO_THROW(Validate(options));
  EXPECT_FALSE(options.IsFast());
  options.implementation = Implementation::kFast;
  EXPECT_THROW(Validate(options), InputError);
  options.solver = MinimalSolver::kFivePoint;
  EXPECT_NO_THROW(Validate(options));
}

TEST(FindEstimator, AnUnknownNameListsTheKnownOnes) {
  try {
    FindEstimator("magsac");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("standard, prcme, rcme"));
  }
}

TEST(MakeEstimator, OptionsThatContradictEachOtherAreErrors) {
  EXPECT_THROW(MakeEstimator("rcme", {{"selection", "predictive_likelihood"}}), InputError);
  EXPECT_NO_THROW(MakeEstimator("rcme", {{"selection", "predictive_likelihood"}, {"reading", "rank_aware"}}));
}

}  // namespace
}  // namespace rcme
