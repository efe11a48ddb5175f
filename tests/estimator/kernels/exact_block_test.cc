// Eight five-point motions side by side against the scalar Hypothesis, on every instruction set.
#include "estimator/kernels/exact_block.h"

#include <gtest/gtest.h>

#include "estimator/hypothesis.h"
#include "estimator/kernels/block_search.h"
#include "estimator/kernels/score.h"
#include "estimator/ransac_loop.h"
#include "estimator/solvers/five_point.h"
#include "tests/test_support/every_target.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

class ExactBlockTest : public OnEveryTarget {};

MotionProblem MakeProblem(std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2720});
  MotionProblem problem = MakeRandomProblem(rng, {.num_matches = 60}).problem;
  AddNoise(0.5, rng, &problem);
  return problem;
}

Correspondence Whitened(const MatchBlocks& matches, int match) {
  const MatchBlock& at = matches[match / kBlockSize];
  const int l = match % kBlockSize;
  return {{at.x1[l], at.y1[l]}, {at.x2[l], at.y2[l]}};
}

double ExactVarianceOfG(const HypothesisBlock& block, int lane, const Correspondence& whitened) {
  double variance = 0.0;
  for (const auto& dF : block.dF) {
    Eigen::Matrix3d matrix;
    for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = dF[i][lane];
    variance += std::pow(EvaluateConstraint(matrix, whitened).g, 2);
  }
  return variance;
}
double ExactVarianceOfG(const UncertainFundamental& model, const Correspondence& match) {
  double variance = 0.0;
  for (const Eigen::Matrix3d& dF : model.dF_whitened) {
    variance += std::pow(EvaluateConstraint(dF, match).g, 2);
  }
  return variance;
}

// F up to its sign, and the variance of g of matches; tolerance: rounding times the gain of the sample.
TEST_F(ExactBlockTest, IsTheScalarHypothesis) {
  Run([] {
    int num_models = 0, num_sharp = 0;
    for (std::uint32_t trial = 0; trial < 20; ++trial) {
      const MotionProblem problem = MakeProblem(trial);
      const MatchBlocks matches(problem);
      RandomStream rng({.seed = 1, .trial = trial, .purpose = 2721});
      BlockSource<FivePoint> source;
      HypothesisBlock block;
      ProposalBlock proposals;
      for (int turn = 0; turn < 4; ++turn) {
        source.FillNext(matches, RequestedOutputs::kCovariance, rng, &block, &proposals);
        for (int lane = 0; lane < kBlockSize; ++lane) {
          if (!(block.is_model >> lane & 1)) continue;
          BlockSource<FivePoint> again;
          auto scalar =
              again.FindHypothesis(problem, matches, proposals[static_cast<size_t>(lane)].id).value();
          PropagateCovariance(problem, &scalar);
          const double tolerance = 1e-12 * scalar.model.G.norm();
          ++num_models;
          num_sharp += tolerance < 1e-6;
          const Eigen::Matrix3d expected = matches.FundamentalFromEssential(EssentialFromPose(scalar.pose));
          Eigen::Matrix3d F;
          for (int i = 0; i < 9; ++i) F(i / 3, i % 3) = block.F[i][lane];
          EXPECT_LT(std::min((F - expected).norm(), (F + expected).norm()), tolerance * expected.norm());
          const UncertainFundamental model = ComputeUncertainFundamental(problem, scalar).value();
          for (int i = 0; i < 60; i += 7) {
            const double variance = ExactVarianceOfG(model, problem.matches[static_cast<size_t>(i)]);
            EXPECT_GT(variance, 0.0);
            EXPECT_NEAR(ExactVarianceOfG(block, lane, Whitened(matches, i)), variance, tolerance * variance);
          }
        }
      }
    }
    EXPECT_GT(num_models, 400);
    EXPECT_GT(num_sharp, 9 * num_models / 10);
  });
}

// The samples that the reference draws, in its order; where both find as many models, with its numbers. The
// solvers differ in a hundredth of the samples (five_point_block_test.cc).
TEST_F(ExactBlockTest, NumbersSamplesAndModelsAsTheReferenceDoes) {
  Run([] {
    const MotionProblem problem = MakeProblem(100);
    const MatchBlocks matches(problem);
    RandomStream rng({.seed = 1, .purpose = 2722}), reference_rng({.seed = 1, .purpose = 2722});
    BlockSource<FivePoint> source;
    HypothesisBlock block;
    ProposalBlock proposals;
    size_t lane = kBlockSize;
    int num_same = 0;
    for (int j = 0; j < 200; ++j) {
      const Sample sample = DrawSample(5, 60, reference_rng);
      int model = 0;
      for (bool is_last = false; !is_last; ++model, ++lane) {
        if (lane == kBlockSize) {
          source.FillNext(matches, RequestedOutputs::kNone, rng, &block, &proposals);
          lane = 0;
        }
        EXPECT_EQ(proposals[lane].id, (HypothesisId{sample, model}));
        is_last = proposals[lane].is_last;
      }
      const auto expected = InstantiateModels<FivePoint>(problem, sample);
      if (expected.count != model) continue;
      ++num_same;
      BlockSource<FivePoint> again;
      for (int k = 0; k < model; ++k) {
        const auto found = again.FindHypothesis(problem, matches, {sample, k}).value();
        const Vector9d &f = found.model.f, &f_expected = expected.models[static_cast<size_t>(k)].model.f;
        EXPECT_LT(std::min((f - f_expected).norm(), (f + f_expected).norm()), 1e-6);
      }
    }
    EXPECT_GE(num_same, 180);
  });
}

TEST(RemoveSample, TakesItsInliersAndTheirSpreadsOut) {
  const MotionProblem problem = MakeProblem(101);
  const MatchBlocks matches(problem);
  InlierScan scan(matches);
  scan.inliers = MakeMask(std::vector<int>{1, 7, 8, 20, 59}, matches);
  scan.num_inliers = 5;
  for (size_t i = 0; i < 5; ++i) scan.spreads[i] = std::vector<double>{1.0, 7.0, 8.0, 20.0, 59.0}[i];
  RemoveSample({59, 8, 9, 1}, &scan);
  EXPECT_EQ(ListIndices(scan.inliers), (std::vector<int>{7, 20}));
  EXPECT_EQ(scan.num_inliers, 2);
  EXPECT_EQ(scan.spreads[0], 7.0);
  EXPECT_EQ(scan.spreads[1], 20.0);
}

}  // namespace
}  // namespace rcme
