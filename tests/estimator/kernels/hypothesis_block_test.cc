// Eight hypotheses side by side against the scalar Hypothesis, on every instruction set. What the tolerances
// scale with: an error of rounding in M moves f by |G| times as much, and f moves E by 1 over the gap between
// its second and third singular value (squared: E is found from M M').
#include "estimator/kernels/hypothesis_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "estimator/geometry/sampson.h"
#include "estimator/point_consistency.h"
#include "estimator/ransac_loop.h"
#include "estimator/sample_consistency.h"
#include "estimator/solvers/eight_point.h"
#include "tests/test_support/every_target.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

class HypothesisBlockTest : public OnEveryTarget {};

using Samples = std::array<Sample, kBlockSize>;

// Sixty matches with noise, every tenth wrong, and eight samples of them.
struct SampledProblem {
  MotionProblem problem;
  Samples samples{};
};
SampledProblem MakeSampledProblem(std::uint32_t trial, double sigma_px = 0.5) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2620});
  SampledProblem c{MakeRandomProblem(rng, {.num_matches = 60}).problem};
  AddNoise(sigma_px, rng, &c.problem);
  for (size_t i = 0; i < 60; i += 10) {
    c.problem.matches[i].x2_px << rng.Uniform(0.0, 799.0), rng.Uniform(0.0, 599.0);
  }
  for (Sample& sample : c.samples) sample = DrawSample(8, 60, rng);
  return c;
}

HypothesisBlock Instantiate(const SampledProblem& c, RequestedOutputs outputs) {
  HypothesisBlock block;
  InstantiateModels(MatchBlocks(c.problem), c.samples, outputs, &block);
  return block;
}

Eigen::Matrix3d ReadMatrix(const HypothesisBlock::Row (&rows)[9], int lane) {
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = rows[i][lane];
  return matrix;
}

std::optional<Hypothesis<EightPoint>> Scalar(const MotionProblem& problem, const Sample& sample) {
  std::optional<Hypothesis<EightPoint>> hypothesis = InstantiateModel<EightPoint>(problem, {sample});
  if (hypothesis) PropagateCovariance(problem, &*hypothesis);
  return hypothesis;
}

double Conditioning(const Hypothesis<EightPoint>& hypothesis) {
  const Eigen::Vector3d& s = hypothesis.projection.singular_values;
  return hypothesis.model.G.norm() * s(0) * s(0) / (s(1) * s(1) - s(2) * s(2));
}

// sum_k (x2' dF_k x1)^2 of the block and of the scalar model, of one match.
double VarianceOfG(const HypothesisBlock& block, int lane, const MatchBlocks& matches, int match) {
  const MatchBlock& at = matches[match / kBlockSize];
  const int l = match % kBlockSize;
  const Correspondence whitened{{at.x1[l], at.y1[l]}, {at.x2[l], at.y2[l]}};
  double variance = 0.0;
  for (const auto& dF : block.dF)
    variance += std::pow(EvaluateConstraint(ReadMatrix(dF, lane), whitened).g, 2);
  return variance;
}
double VarianceOfG(const UncertainFundamental& model, const Correspondence& match) {
  double variance = 0.0;
  for (const Eigen::Matrix3d& dF : model.dF_whitened)
    variance += std::pow(EvaluateConstraint(dF, match).g, 2);
  return variance;
}

// The greatest of many errors over the tolerance, and how many tolerances are sharp enough to mean something.
struct Errors {
  double greatest = 0.0;
  int num = 0, num_sharp = 0;
  void Add(double error, double tolerance) {
    const double ratio = error / tolerance;
    if (!(ratio <= greatest)) greatest = ratio;  // a NaN stays
    ++num;
    num_sharp += tolerance < 1e-6 ? 1 : 0;
  }
};
void ExpectSmall(const Errors& errors, const char* what) {
  EXPECT_LE(errors.greatest, 1.0) << what;
  EXPECT_GT(errors.num_sharp, 95 * errors.num / 100) << what << ": tolerances too wide to test anything";
}

TEST_F(HypothesisBlockTest, IsTheScalarHypothesis) {
  Run([] {
    Errors of_F, of_statistic, of_variance;
    for (std::uint32_t trial = 0; trial < 60; ++trial) {
      const SampledProblem c = MakeSampledProblem(trial);
      const MatchBlocks matches(c.problem);
      const HypothesisBlock block = Instantiate(c, RequestedOutputs::kCovarianceAndMisfit);
      ASSERT_EQ(block.is_model, 0xff);
      for (int lane = 0; lane < kBlockSize; ++lane) {
        const Hypothesis<EightPoint> scalar = Scalar(c.problem, c.samples[static_cast<size_t>(lane)]).value();
        const double tolerance = 1e-13 * Conditioning(scalar);
        const Eigen::Matrix3d F = ReadMatrix(block.F, lane);
        const Eigen::Matrix3d expected = matches.FundamentalFromEssential(EssentialFromPose(scalar.pose));
        of_F.Add(std::min((F - expected).norm(), (F + expected).norm()) / expected.norm(), tolerance);
        const double statistic = JointSampleStatistic(scalar);
        of_statistic.Add(std::abs(block.sample_statistic[lane] / statistic - 1.0), tolerance);
        const auto model =
            UncertainFundamental::From(scalar.pose, scalar.pose_cov, c.problem.camera1, c.problem.camera2);
        for (int i = 0; i < 60; i += 7) {
          const double variance = VarianceOfG(model.value(), c.problem.matches[static_cast<size_t>(i)]);
          of_variance.Add(std::abs(VarianceOfG(block, lane, matches, i) / variance - 1.0), tolerance);
        }
      }
    }
    ExpectSmall(of_F, "F");
    ExpectSmall(of_statistic, "sample statistic");
    ExpectSmall(of_variance, "variance of g");
  });
}

// Matches that a linear model with singular values 1, 1/2 + gap, 1/2 fits exactly, as those of wrong matches
// may be.
SampledProblem MakeProblemOfCloseSingularValues(std::uint32_t trial, double gap) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2622});
  SampledProblem c{MakeRandomProblem(rng, {.num_matches = 64}).problem};
  const Eigen::Matrix3d M =
      RandomPose(rng, 180.0).R * Eigen::Vector3d(1.0, 0.5 + gap, 0.5).asDiagonal() * RandomPose(rng, 180.0).R;
  for (Correspondence& match : c.problem.matches) {  // any point of the epipolar line
    const Eigen::Vector3d line = M * c.problem.camera1.Ray(match.x1_px);
    const int free = std::abs(line(0)) < std::abs(line(1)) ? 0 : 1;
    Eigen::Vector3d ray(0.0, 0.0, 1.0);
    ray(free) = rng.Uniform(-0.4, 0.4);
    ray(1 - free) = -(line(free) * ray(free) + line(2)) / line(1 - free);
    match.x2_px = c.problem.camera2.Project(ray);
  }
  c.samples.fill(Sample(8));
  for (int i = 0; i < 64; ++i) c.samples[static_cast<size_t>(i / 8)][static_cast<size_t>(i % 8)] = i;
  return c;
}

// Rounding over the gap. The closed form alone leaves rounding over its square: ninety times the tolerance
// here, and in 26,000 printed hypotheses of a few inliers up to 1.3e-4 nats between the implementations.
TEST_F(HypothesisBlockTest, IsTheScalarHypothesisWhereSingularValuesAreClose) {
  Run([] {
    Errors of_F;
    for (std::uint32_t trial = 0; trial < 60; ++trial) {
      const SampledProblem c = MakeProblemOfCloseSingularValues(trial, trial % 2 == 0 ? 1e-4 : 1e-5);
      const MatchBlocks matches(c.problem);
      const HypothesisBlock block = Instantiate(c, RequestedOutputs::kNone);
      for (int lane = 0; lane < kBlockSize; ++lane) {
        const Hypothesis<EightPoint> scalar =
            InstantiateModel<EightPoint>(c.problem, {c.samples[static_cast<size_t>(lane)]}).value();
        const Eigen::Matrix3d F = ReadMatrix(block.F, lane);
        const Eigen::Matrix3d expected = matches.FundamentalFromEssential(EssentialFromPose(scalar.pose));
        of_F.Add(std::min((F - expected).norm(), (F + expected).norm()) / expected.norm(),
                 1e-13 * Conditioning(scalar));
      }
    }
    EXPECT_LE(of_F.greatest, 1.0);
  });
}

TEST_F(HypothesisBlockTest, LessToKnowDoesNotChangeTheRest) {
  const SampledProblem c = MakeSampledProblem(1000);
  Run([&] {
    const HypothesisBlock all = Instantiate(c, RequestedOutputs::kCovarianceAndMisfit);
    const HypothesisBlock some = Instantiate(c, RequestedOutputs::kCovariance),
                          least = Instantiate(c, RequestedOutputs::kNone);
    EXPECT_EQ(std::memcmp(all.F, some.F, sizeof(all.F)), 0);
    EXPECT_EQ(std::memcmp(all.F, least.F, sizeof(all.F)), 0);
    EXPECT_EQ(std::memcmp(all.dF, some.dF, sizeof(all.dF)), 0);
    EXPECT_EQ(some.is_model, 0xff);
    EXPECT_EQ(least.is_model, 0xff);
  });
}

// Makes the first eight matches a degenerate sample.
using Spoil = std::function<void(RandomProblem*)>;

void Reproject(const Eigen::Vector3d& point, size_t i, RandomProblem* random) {
  random->problem.matches[i] =
      ProjectToBoth(point, random->pose_true, random->problem.camera1, random->problem.camera2);
}
const std::vector<std::pair<std::string, Spoil>>& DegenerateSamples() {
  static const std::vector<std::pair<std::string, Spoil>> all = {
      {"a match twice", [](RandomProblem* r) { r->problem.matches[5] = r->problem.matches[2]; }},
      {"a match eight times",
       [](RandomProblem* r) {
         for (size_t i = 1; i < 8; ++i) r->problem.matches[i] = r->problem.matches[0];
       }},
      {"points of a plane",
       [](RandomProblem* r) {
         for (size_t i = 0; i < 8; ++i) {
           const Eigen::Vector3d ray = r->points_in_cam1[i] / r->points_in_cam1[i].z();
           Reproject(8.0 / (1.0 + 0.3 * ray.x() - 0.2 * ray.y()) * ray, i, r);
         }
       }},
      {"a rotation",
       [](RandomProblem* r) {
         r->pose_true.t.setZero();
         for (size_t i = 0; i < 8; ++i) Reproject(r->points_in_cam1[i], i, r);
       }},
      {"a coordinate that is not a number",
       [](RandomProblem* r) { r->problem.matches[6].x2_px.x() = std::numeric_limits<double>::quiet_NaN(); }},
      {"the first coordinate infinite",
       [](RandomProblem* r) { r->problem.matches[0].x1_px.x() = std::numeric_limits<double>::infinity(); }},
  };
  return all;
}

// Twenty exact matches, the first eight spoilt; lane `spoilt` has them, the others draw from the rest.
SampledProblem MakeSpoilt(const Spoil& spoil, size_t spoilt, std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2621});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 30});
  for (size_t i = 8; i < 30; ++i) AddNoise(0.5, rng, &random.problem.matches[i]);
  spoil(&random);
  SampledProblem c{random.problem};
  for (size_t lane = 0; lane < c.samples.size(); ++lane) {
    c.samples[lane] = lane == spoilt ? Sample{0, 1, 2, 3, 4, 5, 6, 7} : DrawSample(8, 22, rng);
    if (lane == spoilt) continue;
    for (int& index : c.samples[lane]) index += 8;
  }
  return c;
}

TEST_F(HypothesisBlockTest, RefusesWhatTheScalarSolverRefuses) {
  Run([] {
    for (const auto& [name, spoil] : DegenerateSamples()) {
      for (std::uint32_t trial = 0; trial < 24; ++trial) {
        const size_t lane = trial % 8;
        const SampledProblem c = MakeSpoilt(spoil, lane, trial);
        EXPECT_FALSE(InstantiateModel<EightPoint>(c.problem, {c.samples[lane]})) << name;
        for (const RequestedOutputs outputs : {RequestedOutputs::kNone, RequestedOutputs::kCovariance,
                                               RequestedOutputs::kCovarianceAndMisfit}) {
          EXPECT_EQ(Instantiate(c, outputs).is_model, 0xff & ~(1u << lane)) << name << ", trial " << trial;
        }
      }
    }
  });
}

TEST_F(HypothesisBlockTest, ALaneDoesNotTouchTheOthers) {
  Run([] {
    for (const auto& [name, spoil] : DegenerateSamples()) {
      for (int spoilt = 0; spoilt < kBlockSize; ++spoilt) {
        SampledProblem c = MakeSpoilt(spoil, static_cast<size_t>(spoilt), 100);
        const HypothesisBlock with = Instantiate(c, RequestedOutputs::kCovarianceAndMisfit);
        c.samples[static_cast<size_t>(spoilt)] = {8, 9, 10, 11, 12, 13, 14, 15};
        const HypothesisBlock without = Instantiate(c, RequestedOutputs::kCovarianceAndMisfit);
        EXPECT_EQ(without.is_model, 0xff);
        for (int lane = 0; lane < kBlockSize; ++lane) {
          if (lane == spoilt) continue;
          EXPECT_EQ(with.sample_statistic[lane], without.sample_statistic[lane]) << name;
          EXPECT_EQ(ReadMatrix(with.F, lane), ReadMatrix(without.F, lane)) << name;
          for (int k = 0; k < 5; ++k)
            EXPECT_EQ(ReadMatrix(with.dF[k], lane), ReadMatrix(without.dF[k], lane));
        }
      }
    }
  });
}

TEST_F(HypothesisBlockTest, EveryLaneGivesTheSameBits) {
  // A sample's hypothesis may not depend on the lane it is in.
  SampledProblem c = MakeSampledProblem(2000);
  c.samples.fill(c.samples[3]);
  Run([&] {
    const HypothesisBlock block = Instantiate(c, RequestedOutputs::kCovarianceAndMisfit);
    for (int lane = 1; lane < kBlockSize; ++lane) {
      EXPECT_EQ(ReadMatrix(block.F, lane), ReadMatrix(block.F, 0));
      EXPECT_EQ(block.sample_statistic[lane], block.sample_statistic[0]);
      for (int k = 0; k < 5; ++k) EXPECT_EQ(ReadMatrix(block.dF[k], lane), ReadMatrix(block.dF[k], 0));
    }
  });
}

}  // namespace
}  // namespace rcme
