// The fast implementation against the reference on whole estimates: same samples, verdicts, inlier sets and
// winner. What differs must be a tie within rounding, so each disagreement is replayed hypothesis by
// hypothesis and printed with its distance to the tie.
//
// RCME_AGREEMENT_TRIALS=20000 makes it the long study: as many trials for each of the variants.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <map>
#include <mutex>
#include <thread>

#include "estimator/solvers/solver_list.h"
#include "stats/intervals.h"
#include "tests/estimator/agreement/difference.h"
#include "tests/estimator/agreement/given_models.h"
#include "tests/estimator/agreement/loop_replay.h"
#include "tests/estimator/agreement/refinement_replay.h"
#include "tests/estimator/agreement/variant.h"

namespace rcme::agreement {
namespace {

// At most this share of the trials may differ.
constexpr double kAllowedRate = 0.001;
constexpr double kAllowedOtherModels = 0.25;
// False alarm of a test against it: at most 5e-5 a variant.
constexpr double kConfidence = 0.9999;

// Of two estimates whose hypotheses agree.
template <typename Solver>
Cause CauseAfterTheLoop(const Variant& variant, const MotionProblem& problem, const MotionEstimate& fast,
                        const MotionEstimate& reference) {
  if (!HaveSameWinner(fast, reference)) {
    return {"selection or cheirality", RelativeDifference(fast.mean_entropy, reference.mean_entropy)};
  }
  const MatchMask support = FindWinnersSupport<Solver>(variant, problem, fast.hypothesis);
  const std::optional<Cause> cause =
      RefinementReplay(problem).FindCause(support, fast.initial_pose, reference.initial_pose);
  return cause.value_or(Cause{"unknown", std::nan("")});
}

constexpr const char* kMissedModel = "missed model";

template <typename Solver>
Cause FindDifferenceCause(const Variant& variant, const MotionProblem& problem, std::uint32_t trial,
                          Difference difference, const MotionEstimate& fast,
                          const MotionEstimate& reference) {
  if (difference == Difference::kMissedModel) return {kMissedModel, 0.0};
  const RansacOptions options = variant.Options();
  const bool tests_sample = variant.estimator == "rcme" && Solver::kSampleTestDof > 0;
  std::optional<Cause> cause;
  if (difference != Difference::kEstimate) {
    cause = variant.estimator == "standard"
                ? Replay<Solver, KnownPoseTest>(problem, options, false, trial).FindCause()
            : variant.reading == Reading::kRankAware
                ? Replay<Solver, RankAwareTest>(problem, options, tests_sample, trial).FindCause()
                : Replay<Solver, AsPrintedTest>(problem, options, tests_sample, trial).FindCause();
  }
  return cause ? *cause : CauseAfterTheLoop<Solver>(variant, problem, fast, reference);
}

Cause FindCause(const Variant& variant, const MotionProblem& problem, std::uint32_t trial,
                Difference difference, const MotionEstimate& fast, const MotionEstimate& reference) {
  return variant.solver == MinimalSolver::kFivePoint
             ? FindDifferenceCause<FivePoint>(variant, problem, trial, difference, fast, reference)
             : FindDifferenceCause<EightPoint>(variant, problem, trial, difference, fast, reference);
}

struct Disagreement {
  std::uint32_t trial;
  Differing difference;
  Cause cause;
};

// A variant's disagreements, and its trials in which the solvers found different models.
struct Compared {
  std::vector<Disagreement> found;
  std::int64_t num_with_other_models = 0;
};

// Of every variant over `num_trials` trials, on all cores.
std::vector<Compared> CompareImplementations(std::uint32_t num_trials, const RansacOptions& fast_options) {
  std::vector<Compared> compared(Variants().size());
  std::mutex mutex;
  std::atomic<std::uint32_t> next = 0;
  const auto work = [&] {
    for (std::uint32_t trial = next++; trial < num_trials; trial = next++) {
      if (trial > 0 && trial % 1000 == 0) fmt::print(stderr, "trial {} of {}\n", trial, num_trials);
      const MotionProblem problem = MakeProblem(trial);
      for (size_t a = 0; a < Variants().size(); ++a) {
        const Variant& variant = Variants()[a];
        const MotionEstimate fast = Estimate(variant, fast_options, Implementation::kFast, problem, trial);
        const MotionEstimate reference = Estimate(variant, {}, Implementation::kReference, problem, trial);
        std::optional<LoopResult> given;
        if (!HaveSameModels(variant, problem, trial))
          given = ReferenceOverFastModels(variant, problem, trial);
        const std::optional<Differing> difference = FindDifference(fast, reference, given);
        std::optional<Cause> cause;
        if (difference) cause = FindCause(variant, problem, trial, difference->kind, fast, reference);
        const std::lock_guard lock(mutex);
        if (given) ++compared[a].num_with_other_models;
        if (difference) compared[a].found.push_back({trial, *difference, *cause});
      }
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i) threads.emplace_back(work);
  threads.clear();
  return compared;
}

Compared Together(const std::vector<Compared>& compared) {
  Compared all;
  for (const Compared& one : compared) {
    all.found.insert(all.found.end(), one.found.begin(), one.found.end());
    all.num_with_other_models += one.num_with_other_models;
  }
  return all;
}

std::int64_t Count(const std::vector<Disagreement>& found, Difference kind) {
  return std::ranges::count_if(found, [kind](const Disagreement& d) { return d.difference.kind == kind; });
}

// The rate that a test on n trials finds with probability 0.99: at the least count whose interval lies above
// the allowed rate, P(X >= count) = 0.99.
double DetectableRate(std::int64_t n) {
  std::int64_t count = 1;
  while (count <= n && ExactBinomialInterval(count, n, kConfidence).lower <= kAllowedRate) ++count;
  return ExactBinomialInterval(count - 1, n, 0.98).upper;
}

std::string RateText(std::int64_t count, std::int64_t n) {
  const Interval interval = ExactBinomialInterval(count, n);
  return fmt::format("{} [{:.4f}, {:.4f}] %", count, 100.0 * interval.lower, 100.0 * interval.upper);
}

void PrintRow(const std::string& label, std::int64_t n, const Compared& compared) {
  const std::vector<Disagreement>& found = compared.found;
  struct Kind {
    int count = 0;
    double margin = 0.0;
    std::uint32_t trial = 0;
  };
  std::map<std::string, Kind> kinds;
  for (const Disagreement& d : found) {
    Kind& kind = kinds[d.difference.what + " by " + d.cause.kind];
    if (kind.count++ == 0 || !(d.cause.margin <= kind.margin)) {
      kind.margin = d.cause.margin;
      kind.trial = d.trial;
    }
  }
  std::string text;
  for (const auto& [name, kind] : kinds) {
    text += fmt::format("{}{} {}, at most {:.1e} (trial {})", text.empty() ? "" : "; ", kind.count, name,
                        kind.margin, kind.trial);
  }
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} |\n", label, n,
             RateText(Count(found, Difference::kLoop), n), RateText(Count(found, Difference::kEstimate), n),
             RateText(Count(found, Difference::kEntropy), n), RateText(compared.num_with_other_models, n),
             RateText(Count(found, Difference::kMissedModel), n), text);
}

void PrintTable(std::int64_t num_trials, const std::vector<Compared>& compared) {
  fmt::print(
      "| variant | trials | loop differs | status or final inliers alone | entropy by more than 1e-9 alone | "
      "models differ | another winner there | what, why, distance to the tie |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (size_t a = 0; a < compared.size(); ++a) PrintRow(Variants()[a].label, num_trials, compared[a]);
  const std::int64_t n = num_trials * std::ssize(compared);
  PrintRow("all", n, Together(compared));
  fmt::print("Found with probability 0.99: a rate of {:.2f} % in one variant, {:.2f} % overall.\n",
             100.0 * DetectableRate(num_trials), 100.0 * DetectableRate(n));
}

// Decisions differ in at most 0.1 % of the trials, each a tie within rounding. Rarer than 1 % are winners
// that differ because one solver misses a model: mostly it is the winner of the other, but in trial 386 of
// five_point_rcme_rank_aware it has 487 of 500 matches in its support, so that the reference's size condition
// leaves out the winner of the fast search, which has 157. As rare are exact ties of the cheirality after the
// robust fit, which motions of few or far matches have. Printed entropies beyond 1e-9 belong to hypotheses
// near the singular set of the printed test (score_test.cc), which is where the least mean entropy finds its
// winner: 96 of 10^5, all but two of prcme_as_printed, the greatest 1.9e-5.
void ExpectAgreement(const std::string& label, std::int64_t n, const std::vector<Disagreement>& found) {
  const std::int64_t num_entropies = Count(found, Difference::kEntropy);
  const std::int64_t num_ties =
      std::ranges::count(found, kCheiralityTie, [](const Disagreement& d) { return d.cause.kind; });
  const std::int64_t num_missed =
      std::ranges::count(found, kMissedModel, [](const Disagreement& d) { return d.cause.kind; });
  const std::int64_t num_decisions =
      static_cast<std::int64_t>(found.size()) - num_entropies - num_ties - num_missed;
  EXPECT_LE(ExactBinomialInterval(num_decisions, n, kConfidence).lower, kAllowedRate) << label;
  for (const std::int64_t count : {num_entropies, num_ties, num_missed}) {
    EXPECT_LE(ExactBinomialInterval(count, n, kConfidence).lower, 10.0 * kAllowedRate) << label;
  }
  for (const Disagreement& d : found) {
    const double greatest = d.difference.kind == Difference::kEntropy ? 1e-3 : 1e-8;
    EXPECT_LE(d.cause.margin, greatest)
        << label << ", trial " << d.trial << ": " << d.difference.what << " by " << d.cause.kind;
  }
}

// Eight points always have one model. Of five points' trials 80 of 432 (18.5 [15.0, 22.5] %) hold a sample,
// of 16, in which one solver finds a solution that the other does not.
void ExpectFewOtherModels(const Variant& variant, std::int64_t n, std::int64_t num_with_other_models) {
  if (variant.solver == MinimalSolver::kEightPoint) {
    EXPECT_EQ(num_with_other_models, 0) << variant.label;
  }
  EXPECT_LE(ExactBinomialInterval(num_with_other_models, n, kConfidence).lower, kAllowedOtherModels)
      << variant.label;
}

std::uint32_t NumTrials() {
  const char* text = std::getenv("RCME_AGREEMENT_TRIALS");
  const size_t one_of_every_condition = 36 * SceneRegistry().size();
  return static_cast<std::uint32_t>(text ? std::strtoul(text, nullptr, 10) : one_of_every_condition);
}

TEST(Implementations, AgreeOnWholeEstimates) {
  const std::uint32_t num_trials = NumTrials();
  ASSERT_GT(num_trials, 0u);
  const std::vector<Compared> compared = CompareImplementations(num_trials, {});
  PrintTable(num_trials, compared);
  for (size_t a = 0; a < compared.size(); ++a) {
    ExpectAgreement(Variants()[a].label, num_trials, compared[a].found);
    ExpectFewOtherModels(Variants()[a], num_trials, compared[a].num_with_other_models);
  }
  ExpectAgreement("all", num_trials * std::ssize(compared), Together(compared).found);
}

TEST(Implementations, ASmallFaultIsSeen) {
  // One part in a hundred more significance moves the thresholds by 0.3 %.
  RansacOptions faulty;
  faulty.significance_level *= 1.01;
  const std::vector<Compared> compared = CompareImplementations(36, faulty);
  for (size_t a = 0; a < compared.size(); ++a) {
    const std::vector<Disagreement>& found = compared[a].found;
    const std::int64_t count = Count(found, Difference::kLoop) + Count(found, Difference::kEstimate);
    EXPECT_GT(ExactBinomialInterval(count, 36, kConfidence).lower, kAllowedRate) << Variants()[a].label;
  }
}

}  // namespace
}  // namespace rcme::agreement
