// What the peers answer: right motions, the inliers that their threshold says, a covariance, the same bytes
// from every thread, a status whatever comes in, and no thread of their own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <set>
#include <thread>

#include "estimator/uncertainty/motion_covariance.h"
#include "experiments/audit/contract/contract_problems.h"
#include "experiments/audit/contract/estimate_difference.h"
#include "experiments/trial/answer_check.h"
#include "stats/intervals.h"
#include "tests/peers/peer_entries.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

MotionEstimate Estimate(const EstimatorVariant& variant, const MotionProblem& problem, std::uint32_t trial) {
  RandomStream rng({1, 0, trial, 4});
  return variant.Make()->Estimate(problem, rng);
}

bool IsNear(const MotionEstimate& estimate, const RelativePose& pose_true, double max_rotation_rad,
            double max_direction_rad) {
  return estimate.status == MotionStatus::kOk &&
         RotationAngleBetween(estimate.cam2_from_cam1.R, pose_true.R) <= max_rotation_rad &&
         AngleBetween(estimate.cam2_from_cam1.t, pose_true.t) <= max_direction_rad;
}

class Peers : public testing::TestWithParam<EstimatorVariant> {};
// For what lies in the library's call alone, whatever is done with its answer.
class PeerLibraries : public testing::TestWithParam<EstimatorVariant> {};

// Two cameras that differ in everything. The matches are exact; OpenCV's USAC holds them in single precision.
TEST_P(Peers, FindTheMotionOfExactMatches) {
  for (std::uint32_t trial = 0; trial < 5; ++trial) {
    RelativePose pose_true;
    MotionProblem problem = TwoCameraProblem(100, 0.0, 0.0, trial, &pose_true);
    problem.sigma_px = 0.01;
    const MotionEstimate estimate = Estimate(GetParam(), problem, trial);
    EXPECT_TRUE(IsNear(estimate, pose_true, 1e-4, 1e-3)) << estimate.message;
    EXPECT_EQ(estimate.num_explained, 100);
    EXPECT_GT(estimate.inliers.size(), 90u);
    if (trial > 0) continue;
    std::swap(problem.camera1, problem.camera2);
    EXPECT_FALSE(IsNear(Estimate(GetParam(), problem, trial), pose_true, 1e-4, 1e-3));
  }
}

// More than half, by an exact bound of false alarm rate .001, of trials with noise and a fifth of the matches
// wrong: 43 of 60. A library that finds eight of ten has as many with probability .96, nine of ten with
// .9999.
TEST_P(PeerLibraries, FindMostMotionsAmongWrongMatches) {
  constexpr int kNumTrials = 60;
  int num_near = 0;
  for (std::uint32_t trial = 0; trial < kNumTrials; ++trial) {
    RelativePose pose_true;
    const MotionProblem problem = TwoCameraProblem(150, 0.5, 0.2, trial, &pose_true);
    num_near += IsNear(Estimate(GetParam(), problem, trial), pose_true, 0.052, 0.26);
  }
  EXPECT_GT(ExactBinomialInterval(num_near, kNumTrials, 0.998).lower, 0.5) << num_near;
}

// The threshold is in standard deviations of the distance: of true matches, 68 % are within one and 95 %
// within two. That is asked of 10 noisy matches among 290 exact ones, which leave hardly any doubt about the
// motion, before any refinement that would draw it to the noisy ones. Standard errors over 1,200 of them are
// .013 and .006; where the normals of a match's two epipolar lines differ in length by the ratio of the focal
// lengths, the deviation is up to 2 % wider. A distance that is off by a factor of 1.2 would be seen.
TEST_P(PeerLibraries, TakeTheirThresholdInStandardDeviations) {
  const std::unique_ptr<EstimatorModel> model = FindEstimator(GetParam().estimator).make();
  const std::vector<Parameter> options = model->Parameters();
  if (std::ranges::count(options, "threshold_sigma", &Parameter::name) == 0) return;
  for (const auto& [threshold, share] : {std::pair{"1", 0.683}, {"2", 0.954}}) {
    EstimatorVariant variant = GetParam();
    variant.options.emplace_back("threshold_sigma", threshold);
    variant.options.emplace_back("confidence", "0.99999");
    if (std::ranges::count(options, "refinement", &Parameter::name) > 0)
      variant.options.emplace_back("refinement", "none");
    double num_inliers = 0.0, num_noisy = 0.0;
    for (std::uint32_t trial = 0; trial < 120; ++trial) {
      RelativePose pose_true;
      MotionProblem problem = TwoCameraProblem(300, 0.0, 0.0, trial, &pose_true);
      problem.sigma_px = 0.5;
      RandomStream rng({.seed = 1, .trial = trial, .purpose = 2731});
      for (size_t i = 290; i < 300; ++i) AddNoise(0.5, rng, &problem.matches[i]);
      const MotionEstimate estimate = Estimate(variant, problem, trial);
      if (!IsNear(estimate, pose_true, 2e-4, 2e-3)) continue;  // of other motions, more is in the distance
      num_inliers +=
          static_cast<double>(std::ranges::count_if(estimate.inliers, [](int i) { return i >= 290; }));
      num_noisy += 10.0;
    }
    EXPECT_GE(num_noisy, 300.0) << threshold;
    EXPECT_NEAR(num_inliers / num_noisy, share, 0.04) << threshold << " of " << num_noisy;
  }
}

TEST_P(Peers, GiveTheCovarianceOfTheirInliers) {
  const MotionProblem problem = TwoCameraProblem(100, 0.5, 0.2, 0);
  const MotionEstimate estimate = Estimate(GetParam(), problem, 0);
  ASSERT_EQ(estimate.status, MotionStatus::kOk) << estimate.message;
  std::vector<Correspondence> inliers;
  for (const int i : estimate.inliers) inliers.push_back(problem.matches[static_cast<size_t>(i)]);
  const auto first_order = FirstOrderMotionCovariance(estimate.cam2_from_cam1, problem.camera1,
                                                      problem.camera2, inliers, problem.sigma_px);
  ASSERT_TRUE(first_order);
  const Settings robust = {{"covariance", "robust"}};
  const bool is_robust = std::ranges::count(GetParam().options, robust.front()) > 0;
  EXPECT_TRUE(is_robust || estimate.pose_cov == *first_order);
  // Greater where the motion is not at the optimum of its inliers (OpenCV's of F).
  EXPECT_GT(estimate.pose_cov.trace(), 0.6 * first_order->trace());
  EXPECT_GT(estimate.num_explained, 40);
  EXPECT_LE(estimate.num_explained, 100);
}

TEST_P(PeerLibraries, GiveTheSameBytesOnEveryThread) {
  const std::unique_ptr<MotionEstimator> estimator = GetParam().Make();
  std::vector<MotionProblem> problems;
  std::vector<MotionEstimate> alone;
  for (std::uint32_t trial = 0; trial < 4; ++trial) {
    problems.push_back(TwoCameraProblem(100, 0.5, 0.2, trial));
    alone.push_back(Estimate(GetParam(), problems.back(), trial));
  }
  std::vector<std::string> differences(4);
  {
    std::vector<std::jthread> threads;
    for (std::uint32_t thread = 0; thread < 4; ++thread) {
      threads.emplace_back([&, thread] {
        for (std::uint32_t k = 0; k < 4; ++k) {
          const std::uint32_t trial = (thread + k) % 4;
          RandomStream rng({1, 0, trial, 4});
          const auto difference = FirstDifference(alone[trial], estimator->Estimate(problems[trial], rng));
          if (difference) differences[thread] = *difference;
        }
      });
    }
  }
  EXPECT_THAT(differences, testing::Each(""));
}

// Where the samples are few and most matches wrong, another stream draws others.
TEST_P(PeerLibraries, DrawTheirSamplesFromTheStream) {
  const MotionProblem problem = TwoCameraProblem(60, 0.5, 0.6, 0);
  const MotionEstimate first = Estimate(GetParam(), problem, 0);
  int num_others = 0;
  for (std::uint32_t stream = 1; stream < 6; ++stream) {
    num_others += FirstDifference(first, Estimate(GetParam(), problem, stream)).has_value();
  }
  EXPECT_GT(num_others, 0);
}

INSTANTIATE_TEST_SUITE_P(All, Peers, testing::ValuesIn(PeerVariants()),
                         [](const auto& c) { return c.param.name; });
INSTANTIATE_TEST_SUITE_P(All, PeerLibraries, testing::ValuesIn(PeerLibraryCalls()),
                         [](const auto& c) { return c.param.name; });

TEST(PeerLibraryCalls, EveryPeerIsAmongTheCalls) {
  std::map<std::string, int> num_calls;
  for (const EstimatorVariant& variant : PeerLibraryCalls()) ++num_calls[variant.estimator];
  EXPECT_EQ(num_calls.size(), PeerEntries().size());
  EXPECT_GE(num_calls["opencv_usac"], 10);
}

double CpuSeconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// No other thread of the process works while a peer does.
TEST(PeerCalls, StayOnTheirThread) {
  double in_thread = 0.0, in_process = 0.0;
  for (const EstimatorVariant& variant : PeerVariants()) {
    const std::unique_ptr<MotionEstimator> estimator = variant.Make();
    const MotionProblem problem = TwoCameraProblem(500, 0.5, 0.4, 0);
    const double thread_start = CpuSeconds(CLOCK_THREAD_CPUTIME_ID);
    const double process_start = CpuSeconds(CLOCK_PROCESS_CPUTIME_ID);
    RandomStream rng({1, 0, 0, 4});
    estimator->Estimate(problem, rng);
    in_thread += CpuSeconds(CLOCK_THREAD_CPUTIME_ID) - thread_start;
    in_process += CpuSeconds(CLOCK_PROCESS_CPUTIME_ID) - process_start;
  }
  EXPECT_LT(in_process, 1.01 * in_thread + 0.001);
}

std::string FaultOn(const EstimatorVariant& variant, const MotionProblem& problem, bool has_no_motion) {
  const MotionEstimate estimate = Estimate(variant, problem, 0);
  if (const auto fault = FindFault(estimate, problem.matches.size())) return fault->message;
  if (estimate.message.empty()) return "no message";
  if (estimate.status == MotionStatus::kOk && has_no_motion) return "a motion";
  return "";
}

// The combinations in groups that differ in no choice of the library's own: only in what is done with its
// answer, as of any estimator (robust covariance, gate of model choice).
std::vector<std::vector<EstimatorVariant>> PeerCombinationsByLibraryCall() {
  std::map<std::string, std::vector<EstimatorVariant>> groups;
  for (const EstimatorVariant& variant : PeerCombinations()) {
    std::string call = variant.estimator;
    for (const auto& [name, word] : variant.options) {
      if (!IsOfTheAnswer(name)) call += " " + word;
    }
    groups[call].push_back(variant);
  }
  std::vector<std::vector<EstimatorVariant>> all;
  for (const auto& [call, group] : groups) all.push_back(group);
  return all;
}

// What no peer may crash, hang or throw at. Every combination of the library's choices meets every problem
// with six of the ways to go on with its answer, taken in turn: so every combination of all choices meets
// some problem, and every way meets every problem, after many calls of libraries.
TEST(PeerCalls, EndInAStatusWhateverComesIn) {
  const std::vector<std::vector<EstimatorVariant>> groups = PeerCombinationsByLibraryCall();
  const std::vector<ContractProblem> problems = BadProblems(1);
  std::set<std::string> met;
  for (size_t i = 0; i < groups.size(); ++i) {
    const size_t num_ways = std::min<size_t>(6, groups[i].size());
    for (size_t j = 0; j < problems.size(); ++j) {
      for (size_t k = 0; k < num_ways; ++k) {
        EstimatorVariant variant = groups[i][(i + num_ways * j + k) % groups[i].size()];
        met.insert(variant.name);
        variant.options.emplace_back("max_iterations", "100");
        EXPECT_EQ(FaultOn(variant, problems[j].problem, problems[j].has_no_motion), "")
            << variant.name << ": " << problems[j].name;
      }
    }
  }
  EXPECT_EQ(met.size(), PeerCombinations().size());
}

// Images of all sizes and places: OpenCV sorts points into the cells of a grid. Every combination of the
// library's choices meets every place, with two of the ways to go on with its answer.
TEST(PeerCalls, EndInAStatusWhereverTheImageLies) {
  RandomStream rng({.seed = 1, .purpose = 2732});
  size_t num_calls = 0;
  for (const std::vector<EstimatorVariant>& group : PeerCombinationsByLibraryCall()) {
    for (const double scale : {1e-6, 0.01, 1.0, 1000.0}) {
      for (const double shift_px : {-9e5, -500.0, 0.0, 9e5}) {
        MotionProblem problem = TwoCameraProblem(30, 0.5, 0.3, 0);
        problem.sigma_px *= scale;
        for (Correspondence& match : problem.matches) {
          match.x1_px = (scale * match.x1_px).array() + shift_px;
          match.x2_px = (scale * match.x2_px).array() + shift_px;
        }
        for (int k = 0; k < 2; ++k) {
          EstimatorVariant variant = group[rng.IntegerBelow(static_cast<std::uint32_t>(group.size()))];
          variant.options.emplace_back("max_iterations", "30");
          EXPECT_EQ(FaultOn(variant, problem, false), "")
              << variant.name << ": " << scale << ", " << shift_px;
          ++num_calls;
        }
      }
    }
  }
  EXPECT_GE(num_calls, 70u * 16u * 2u);  // USAC 60, OpenGV 8, OpenCV's two for the fundamental matrix
}

}  // namespace
}  // namespace rcme
