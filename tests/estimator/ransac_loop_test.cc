#include "estimator/ransac_loop.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

#include "estimator/estimators/standard.h"
#include "estimator/kernels/block_search.h"
#include "estimator/reference_search.h"
#include "estimator/solvers/solver_table.h"
#include "tests/test_support/two_camera_scene.h"

namespace {
std::atomic<long> num_allocations{0};
}  // namespace

// Counts every heap allocation of this test program.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++num_allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++num_allocations;
  return std::malloc(size > 0 ? size : 1);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace rcme {
namespace {

template <typename PointTestT>
struct CountOf : InlierCountDecision {
  using PointTest = PointTestT;
  using InlierCountDecision::InlierCountDecision;
};

// The loop as an estimator runs it: most inliers win.
template <typename Search>
LoopResult RunByCount(const RansacOptions& options, int num_matches, Search& search) {
  return RunRansacLoop(options, num_matches, search, search,
                       InlierCountDecision(options, search.thresholds()));
}

template <typename Solver>
MinimalSolver FindSolverChoice() {
  for (const auto& [name, choice] : SolverNames()) {
    const bool is_it = VisitSolver(
        choice, []<typename Other>(std::type_identity<Other>) { return std::is_same_v<Solver, Other>; });
    if (is_it) return choice;
  }
  throw std::logic_error("not in the table");
}

// Allocations of the loop alone; `run` makes a search and runs the loop with it.
template <typename MakeAndRun>
void ExpectNoAllocationPerHypothesisOrPoint(MinimalSolver solver, const MakeAndRun& run) {
  const auto count = [&](int num_matches, int num_iterations) {
    const MotionProblem problem = TwoCameraProblem(num_matches, 0.5, 0.2, 0);
    RansacOptions options;
    options.solver = solver;
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

template <typename Solver, typename PointTest>
void ExpectReferenceDoesNotAllocate() {
  ExpectNoAllocationPerHypothesisOrPoint(
      FindSolverChoice<Solver>(),
      [](const MotionProblem& problem, const RansacOptions& options, RandomStream& rng) {
        ReferenceSearch<CountOf<PointTest>, Solver> search(problem, options, rng);
        const long before = num_allocations;
        RunByCount(options, static_cast<int>(problem.matches.size()), search);
        return num_allocations - before;
      });
}

template <typename Solver>
void ExpectBlocksDoNotAllocate(BlockReading reading) {
  ExpectNoAllocationPerHypothesisOrPoint(
      FindSolverChoice<Solver>(),
      [&](const MotionProblem& problem, const RansacOptions& options, RandomStream& rng) {
        const MatchBlocks matches(problem);
        BlockSearch<Solver> search(problem, matches, options, {reading, true, true}, rng);
        const long before = num_allocations;
        RunByCount(options, matches.num_matches(), search);
        return num_allocations - before;
      });
}

TEST(RansacLoop, DoesNotAllocatePerHypothesisOrPoint) {
  ExpectReferenceDoesNotAllocate<EightPoint, KnownPoseTest>();
  ExpectReferenceDoesNotAllocate<EightPoint, AsPrintedTest>();
#define RCME_EXPECT_NO_ALLOCATION(Solver, name) ExpectReferenceDoesNotAllocate<Solver, RankAwareTest>();
  RCME_FOR_EACH_SOLVER(RCME_EXPECT_NO_ALLOCATION)
#undef RCME_EXPECT_NO_ALLOCATION
  for (const BlockReading reading :
       {BlockReading::kKnownPose, BlockReading::kAsPrinted, BlockReading::kRankAware}) {
    ExpectBlocksDoNotAllocate<EightPoint>(reading);
    ExpectBlocksDoNotAllocate<FivePoint>(reading);
  }
}

// A search that has made its hypotheses before: all consistent, with these inliers and mean entropies.
class ScriptedSearch {
 public:
  explicit ScriptedSearch(std::vector<InlierScore> scores) : scores_(std::move(scores)) {}
  const Thresholds& thresholds() const { return thresholds_; }
  Proposal Next() { return {{{static_cast<int>(num_proposed_++)}}, SampleVerdict::kConsistent}; }
  InlierScore Score() const { return scores_[num_proposed_ - 1]; }

 private:
  Thresholds thresholds_;
  std::vector<InlierScore> scores_;
  size_t num_proposed_ = 0;
};

// 100 matches; omega_p = 0.8 and lambda = 0.5 ask for 40 inliers.
LoopResult RunScript(const std::vector<InlierScore>& scores, double early_stop_entropy) {
  RansacOptions options;
  options.num_iterations = static_cast<int>(scores.size());
  options.inlier_ratio = 0.8;
  options.lambda = 0.5;
  options.early_stop_entropy = early_stop_entropy;
  ScriptedSearch search(scores);
  return RunByCount(options, 100, search);
}

TEST(RansacLoop, StopsEarlyOnlyAtAMemberOfTheCandidateSet) {
  // The first and second are certain enough but too small, the third is large enough but not certain enough.
  const LoopResult result = RunScript({{10, -9.0}, {39, -9.0}, {90, -1.0}, {40, -4.0}, {95, -9.0}}, -4.0);
  EXPECT_EQ(result.counts.num_hypotheses, 4) << "an entropy at the bound is enough, and so is a size";
  EXPECT_EQ(result.counts.num_candidates, 2);
  EXPECT_EQ(result.counts.num_too_small_inlier_sets, 2);
  EXPECT_EQ(result.winner->score.num_inliers, 90);
}

TEST(RansacLoop, WithoutABoundItRunsToItsEndAndTheFirstOfEqualsWins) {
  const double off = std::numeric_limits<double>::quiet_NaN();
  const LoopResult result = RunScript({{50, -9.0}, {70, -9.0}, {70, -1.0}}, off);
  EXPECT_EQ(result.counts.num_hypotheses, 3);
  EXPECT_EQ(result.winner->id.sample[0], 1);
  EXPECT_FALSE(RunScript({{39, -9.0}}, off).winner);
}

}  // namespace
}  // namespace rcme
