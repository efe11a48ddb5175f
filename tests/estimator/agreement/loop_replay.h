// The loop of both implementations, hypothesis by hypothesis: where they part, and how far from a tie.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <type_traits>

#include "estimator/kernels/block_search.h"
#include "estimator/reference_search.h"
#include "estimator/sample_consistency.h"
#include "tests/estimator/agreement/difference.h"
#include "tests/estimator/agreement/variant.h"

namespace rcme::agreement {

// Why two implementations part, and how far from a tie: the greatest |quantity / threshold - 1|.
struct Cause {
  std::string kind;
  double margin = 0.0;
};
inline void KeepGreater(const std::string& kind, double margin, std::optional<Cause>* cause) {
  if (!*cause || !(margin <= (*cause)->margin)) *cause = {kind, margin};
}

template <typename PointTest>
constexpr BlockReading FindReading() {
  if (std::is_same_v<PointTest, KnownPoseTest>) return BlockReading::kKnownPose;
  return std::is_same_v<PointTest, RankAwareTest> ? BlockReading::kRankAware : BlockReading::kAsPrinted;
}

// One hypothesis of the reference with all that it decides.
template <typename Solver, typename PointTest>
struct Judged {
  Hypothesis<Solver> hypothesis;
  PointTest test;

  static std::optional<Judged> From(const MotionProblem& problem,
                                    std::optional<Hypothesis<Solver>> hypothesis) {
    if (!hypothesis) return std::nullopt;
    if constexpr (!PointTest::kNeedsCovariance) {
      return Judged{*hypothesis, PointTest(hypothesis->F, problem.sigma_px)};
    } else {
      PropagateCovariance(problem, &*hypothesis);
      const auto model = ComputeUncertainFundamental(problem, *hypothesis);
      if (!model) return std::nullopt;
      return Judged{*hypothesis, PointTest(*model, problem.sigma_px)};
    }
  }

  double Distance(const Correspondence& match) const {
    PointResidual residual;
    return test.Distance(match, &residual);
  }

  // Statistic of the sample test over its threshold.
  double SampleStatistic(const MotionProblem& problem, const Thresholds& thresholds) const {
    if constexpr (Solver::kSampleTestDof == 0) {
      return 0.0;
    } else if constexpr (std::is_same_v<PointTest, RankAwareTest>) {
      return JointSampleStatistic(hypothesis) / thresholds.sample;
    } else {
      double greatest = 0.0;
      for (const int i : hypothesis.id.sample) {
        greatest = std::max(greatest, Distance(problem.matches[static_cast<size_t>(i)]));
      }
      return greatest / thresholds.point;
    }
  }
};

template <typename Solver, typename PointTest>
class Replay {
 public:
  Replay(const MotionProblem& problem, const RansacOptions& options, bool tests_sample, std::uint32_t trial)
      : problem_(problem),
        matches_(problem),
        tests_{FindReading<PointTest>(), tests_sample, false},
        fast_rng_(SamplingStream(trial)),
        reference_rng_(SamplingStream(trial)),
        fast_(problem, matches_, options, tests_, fast_rng_),
        fast_support_(problem, matches_, options, tests_, fast_rng_),
        num_iterations_(options.num_iterations) {}

  std::optional<Cause> FindCause() {
    std::optional<Cause> cause;
    for (int j = 0; j < num_iterations_;) j += CompareNext(&cause);
    return cause;
  }

 private:
  // Returns whether that was the sample's last model.
  bool CompareNext(std::optional<Cause>* cause) {
    const Proposal fast = fast_.Next();
    if (is_first_) sample_ = DrawSample(Solver::kSampleSize, matches_.num_matches(), reference_rng_);
    if (sample_ != fast.id.sample) KeepGreater("other sample", 1.0, cause);
    is_first_ = fast.is_last;
    if (sample_ == fast.id.sample) CompareModel(fast, cause);
    return fast.is_last;
  }

  void CompareModel(const Proposal& fast, std::optional<Cause>* cause) {
    const Thresholds& thresholds = fast_.thresholds();
    const auto judged = Judged<Solver, PointTest>::From(problem_, fast_support_.FindHypothesis(fast.id));
    const bool is_fast_model = fast.verdict != SampleVerdict::kDegenerate;
    if (judged.has_value() != is_fast_model) return KeepGreater("degenerate sample", std::nan(""), cause);
    if (!judged) return;
    const double statistic = tests_.tests_sample ? judged->SampleStatistic(problem_, thresholds) : 0.0;
    if ((statistic <= 1.0) != (fast.verdict == SampleVerdict::kConsistent)) {
      return KeepGreater("sample test", std::abs(statistic - 1.0), cause);
    }
    if (statistic <= 1.0) CompareScores(*judged, fast_.Score(), cause);
  }

  void CompareScores(const Judged<Solver, PointTest>& judged, const InlierScore& fast,
                     std::optional<Cause>* cause) {
    const double threshold = fast_.thresholds().point;
    const MatchMask& support = fast_support_.FindSupport(judged.hypothesis.id);
    bool is_same_set = true;
    for (int i = 0; i < matches_.num_matches(); ++i) {
      const double d2 = judged.Distance(problem_.matches[static_cast<size_t>(i)]);
      const bool is_in_fast = support[static_cast<size_t>(i / kBlockSize)] >> (i % kBlockSize) & 1;
      if ((d2 <= threshold) == is_in_fast) continue;
      is_same_set = false;
      KeepGreater("inlier of a hypothesis", std::abs(d2 / threshold - 1.0), cause);
    }
    if (!is_same_set) return;
    const InlierScore reference =
        ScoreInliers(problem_, judged.test, fast_.thresholds(),
                     kScoresTheRest<Solver, PointTest> ? judged.hypothesis.id.sample : Sample());
    const double difference = RelativeDifference(fast.mean_entropy, reference.mean_entropy);
    if (difference > 1e-9) KeepGreater("entropy of a hypothesis", difference, cause);
  }

  const MotionProblem& problem_;
  MatchBlocks matches_;
  BlockTests tests_;
  RandomStream fast_rng_, reference_rng_;
  BlockSearch<Solver> fast_, fast_support_;
  int num_iterations_;
  Sample sample_;
  bool is_first_ = true;  // the next model is the first of a sample
};

inline BlockTests MakeBlockTests(const Variant& variant) {
  const BlockReading reading = variant.estimator == "standard"          ? BlockReading::kKnownPose
                               : variant.reading == Reading::kRankAware ? BlockReading::kRankAware
                                                                        : BlockReading::kAsPrinted;
  return {reading, variant.estimator == "rcme", false};
}

// The inliers of the loop's winner in the fast implementation.
template <typename Solver>
MatchMask FindWinnersSupport(const Variant& variant, const MotionProblem& problem,
                             const HypothesisId& winner) {
  const MatchBlocks matches(problem);
  RandomStream no_samples({0, 0, 0, 0});
  return BlockSearch<Solver>(problem, matches, variant.Options(), MakeBlockTests(variant), no_samples)
      .FindSupport(winner);
}

}  // namespace rcme::agreement
