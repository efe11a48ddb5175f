#include "estimator/ransac_loop.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <map>
#include <new>
#include <set>

#include "estimator/kernels/block_search.h"
#include "estimator/reference_search.h"
#include "simulator/noise/noise_laws.h"
#include "simulator/observe.h"
#include "simulator/scene_generator.h"
#include "stats/distributions.h"

namespace {
std::atomic<long> num_allocations{0};
}  // namespace

// Counts every heap allocation of this test program.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++num_allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace rcme {
namespace {

struct BarePipeline {
  static bool InlierSetIsGood(double, const RansacOptions&, const Thresholds&) { return true; }
  static bool IsBetter(const InlierScore& a, const InlierScore& b, const RansacOptions&) {
    return a.num_inliers > b.num_inliers;
  }
};

template <typename PointTestT>
struct BareReference : BarePipeline {
  using PointTest = PointTestT;
  static bool SampleIsConsistent(const MotionProblem&, const Hypothesis&, const PointTest&,
                                 const Thresholds&) {
    return true;
  }
};

MotionProblem MakeProblem(int num_matches) {
  SceneGenerator model("uniform_volume");
  FindParameter(model.Parameters(), "num_matches").SetFromText(std::to_string(num_matches));
  RandomStream scene_rng({1, 0, 0, 1}), noise_rng({1, 0, 0, 2}), outlier_rng({1, 0, 0, 3});
  const Scene scene = model.Generate(scene_rng);
  return {Observe(scene, *MakeGaussianNoise(0.5), OutlierModel(0.2), noise_rng, outlier_rng).matches,
          scene.camera1, scene.camera2, 0.5};
}

// Allocations of the loop alone; `run` makes a search and runs the loop with it.
template <typename MakeAndRun>
void ExpectNoAllocationPerHypothesisOrPoint(const MakeAndRun& run) {
  const auto count = [&](int num_matches, int num_iterations) {
    const MotionProblem problem = MakeProblem(num_matches);
    RansacOptions options;
    options.num_iterations = num_iterations;
    RandomStream rng({1, 0, 0, 4});
    return run(problem, options, rng);
  };
  // The candidates, their order and the best of them are one allocation each per call; beyond them nothing
  // depends on the hypotheses or the points.
  const long few = count(100, 100);
  EXPECT_EQ(few, 3);
  EXPECT_EQ(count(100, 400), few);
  EXPECT_EQ(count(1000, 100), few);
}

template <typename PointTest>
void ExpectReferenceDoesNotAllocate() {
  ExpectNoAllocationPerHypothesisOrPoint(
      [](const MotionProblem& problem, const RansacOptions& options, RandomStream& rng) {
        ReferenceSearch<BareReference<PointTest>> search(problem, options, rng);
        const long before = num_allocations;
        RunRansacLoop<BarePipeline>(options, static_cast<int>(problem.matches.size()), search);
        return num_allocations - before;
      });
}

void ExpectBlocksDoNotAllocate(BlockSearch::Reading reading) {
  ExpectNoAllocationPerHypothesisOrPoint(
      [&](const MotionProblem& problem, const RansacOptions& options, RandomStream& rng) {
        const MatchBlocks matches(problem);
        BlockSearch search(problem, matches, options, {reading, true, true}, rng);
        const long before = num_allocations;
        RunRansacLoop<BarePipeline>(options, matches.num_matches(), search);
        return num_allocations - before;
      });
}

TEST(RansacLoop, DoesNotAllocatePerHypothesisOrPoint) {
  ExpectReferenceDoesNotAllocate<KnownPoseTest>();
  ExpectReferenceDoesNotAllocate<AsPrintedTest>();
  ExpectReferenceDoesNotAllocate<RankAwareTest>();
  ExpectBlocksDoNotAllocate(BlockSearch::Reading::kKnownPose);
  ExpectBlocksDoNotAllocate(BlockSearch::Reading::kAsPrinted);
  ExpectBlocksDoNotAllocate(BlockSearch::Reading::kRankAware);
}

TEST(DrawSample, IndicesAreDistinctAndInRange) {
  RandomStream rng({1, 0, 0, 4});
  for (int draw = 0; draw < 1000; ++draw) {
    const Sample sample = DrawSample(8, rng);
    EXPECT_EQ(std::set<int>(sample.begin(), sample.end()), (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7}));
  }
}

// Every one of the 45 sets of 8 out of 10 is equally likely: chi-square with 44 degrees of freedom over
// 45,000 draws, at 1e-5. A set drawn 10 % too often alone adds 10 to the statistic's 44 +- 9.
TEST(DrawSample, EverySetIsEquallyLikely) {
  RandomStream rng({1, 0, 0, 4});
  std::map<std::set<int>, int> counts;
  for (int draw = 0; draw < 45'000; ++draw) {
    const Sample sample = DrawSample(10, rng);
    ++counts[std::set<int>(sample.begin(), sample.end())];
  }
  EXPECT_EQ(counts.size(), 45u);
  double statistic = 0.0;
  for (const auto& [set, count] : counts) statistic += (count - 1000.0) * (count - 1000.0) / 1000.0;
  EXPECT_LT(statistic, ChiSquareQuantile(44, 1.0 - 1e-5));
}

}  // namespace
}  // namespace rcme
