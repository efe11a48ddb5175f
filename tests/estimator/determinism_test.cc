// The same bytes from every call, any number of threads and every instruction set.
#include <gtest/gtest.h>

#include <bit>
#include <thread>

#include "estimator/estimator_registry.h"
#include "estimator/solvers/solver_list.h"
#include "tests/test_support/every_target.h"
#include "tests/test_support/make_ransac.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

constexpr std::uint32_t kNumTrials = 12;

MotionProblem MakeFixedProblem(std::uint32_t trial) { return TwoCameraProblem(120, 0.5, 0.3, trial); }

// Every number of an estimate, as bits.
std::vector<std::uint64_t> ListBits(const MotionEstimate& e) {
  std::vector<std::uint64_t> bits;
  const auto add = [&bits](double value) { bits.push_back(std::bit_cast<std::uint64_t>(value)); };
  for (const RelativePose& pose : {e.cam2_from_cam1, e.initial_pose}) {
    for (const double x : pose.R.reshaped()) add(x);
    for (const double x : pose.t) add(x);
  }
  for (const double x : e.pose_cov.reshaped()) add(x);
  for (const double x : {e.mean_entropy, e.z_statistic}) add(x);
  for (const int i : e.inliers) add(i);
  const LoopCounts& c = e.counts;
  for (const int i :
       {static_cast<int>(e.status), e.num_support, e.num_consistent_before, e.num_consistent_after,
        static_cast<int>(e.failed_by_kappa), c.num_hypotheses, c.num_degenerate_samples,
        c.num_inconsistent_samples, c.num_poor_inlier_sets, c.num_too_small_inlier_sets, c.num_candidates}) {
    add(i);
  }
  return bits;
}

class Determinism
    : public testing::TestWithParam<std::tuple<std::string, Reading, Implementation, MinimalSolver>> {
 protected:
  std::unique_ptr<MotionEstimator> Make() const {
    RansacOptions options;
    options.reading = std::get<Reading>(GetParam());
    options.implementation = std::get<Implementation>(GetParam());
    options.solver = std::get<MinimalSolver>(GetParam());
    return MakeRansac(std::get<std::string>(GetParam()), options);
  }
  static std::vector<std::uint64_t> Estimate(const MotionEstimator& estimator, std::uint32_t trial) {
    RandomStream rng({1, 9, trial, 4});
    return ListBits(estimator.Estimate(MakeFixedProblem(trial), rng));
  }
};

TEST_P(Determinism, TheSameBytesFromRepeatedCallsAndFromSeveralThreadsAtOnce) {
  const std::unique_ptr<MotionEstimator> estimator = Make();
  std::vector<std::vector<std::uint64_t>> first;
  for (std::uint32_t trial = 0; trial < kNumTrials; ++trial) first.push_back(Estimate(*estimator, trial));
  EXPECT_NE(first[0], first[1]) << "bits that never change test nothing";
  for (std::uint32_t trial = kNumTrials; trial-- > 0;) {  // in another order, from another estimator
    EXPECT_EQ(Estimate(*Make(), trial), first[trial]) << trial;
  }
  constexpr std::uint32_t kNumThreads = 4;
  std::vector<std::vector<std::uint64_t>> found(kNumThreads * kNumTrials);
  {
    std::vector<std::jthread> threads;
    for (std::uint32_t t = 0; t < kNumThreads; ++t) {
      threads.emplace_back([&, t] {
        for (std::uint32_t i = 0; i < kNumTrials; ++i) {
          const std::uint32_t trial = (i + 3 * t) % kNumTrials;  // different ones at a time
          found[t * kNumTrials + trial] = Estimate(*estimator, trial);
        }
      });
    }
  }
  for (size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], first[i % kNumTrials]) << i;
}

// Would catch a sum in the order of the vector's length, a product and a sum fused on one set and not on
// another, and a function of Highway that rounds differently.
TEST_P(Determinism, TheSameBytesFromEveryInstructionSet) {
  const std::unique_ptr<MotionEstimator> estimator = Make();
  std::vector<std::vector<std::uint64_t>> first;
  for (std::uint32_t trial = 0; trial < kNumTrials; ++trial) first.push_back(Estimate(*estimator, trial));
  RunOnEveryTarget([&] {
    for (std::uint32_t trial = 0; trial < kNumTrials; ++trial) {
      EXPECT_EQ(Estimate(*estimator, trial), first[trial]) << trial;
    }
  });
}

std::string FormatInstance(const testing::TestParamInfo<Determinism::ParamType>& instance) {
  const bool is_printed = std::get<Reading>(instance.param) == Reading::kAsPrinted;
  const bool is_fast = std::get<Implementation>(instance.param) == Implementation::kFast;
  return std::get<std::string>(instance.param) + (is_printed ? "_printed" : "_rank_aware") +
         (is_fast ? "_fast" : "_reference");
}

INSTANTIATE_TEST_SUITE_P(Estimators, Determinism,
                         testing::Combine(testing::Values("standard", "prcme", "rcme"),
                                          testing::Values(Reading::kAsPrinted, Reading::kRankAware),
                                          testing::Values(Implementation::kFast, Implementation::kReference),
                                          testing::Values(MinimalSolver::kEightPoint)),
                         FormatInstance);
INSTANTIATE_TEST_SUITE_P(FivePoint, Determinism,
                         testing::Combine(testing::Values("standard", "rcme"),
                                          testing::Values(Reading::kAsPrinted, Reading::kRankAware),
                                          testing::Values(Implementation::kFast),
                                          testing::Values(MinimalSolver::kFivePoint)),
                         FormatInstance);

}  // namespace
}  // namespace rcme
