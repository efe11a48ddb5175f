// The loop of the reference over the models that the fast solver finds: what it decides where the two solvers
// find different ones. A model that only one of them finds can change the winner without being it: it may
// have the largest support, from which the size condition of all others follows (candidate_set.h).
#pragma once

#include <optional>

#include "estimator/estimators/standard.h"
#include "estimator/kernels/block_search.h"
#include "estimator/ransac_loop.h"
#include "estimator/reference_search.h"
#include "tests/estimator/agreement/loop_replay.h"
#include "tests/estimator/agreement/variant.h"

namespace rcme::agreement {

// A search for RunRansacLoop: samples and models of the fast search, everything else of the reference. For
// solvers whose sample cannot be tested.
template <typename Solver, typename PointTest>
class SearchOfGivenModels {
  static_assert(Solver::kSampleTestDof == 0);

 public:
  SearchOfGivenModels(const MotionProblem& problem, const MatchBlocks& matches, const RansacOptions& options,
                      RandomStream& rng)
      : problem_(problem),
        fast_(problem, matches, options, {FindReading<PointTest>(), false, false}, rng),
        models_(problem, matches, options, {FindReading<PointTest>(), false, false}, rng) {}

  const Thresholds& thresholds() const { return fast_.thresholds(); }

  Proposal Next() {
    Proposal proposal = fast_.Next();
    judged_.reset();
    if (proposal.verdict != SampleVerdict::kDegenerate)
      judged_ = Judged<Solver, PointTest>::From(problem_, models_.FindHypothesis(proposal.id));
    proposal.verdict = judged_ ? SampleVerdict::kConsistent : SampleVerdict::kDegenerate;
    return proposal;
  }

  InlierScore Score() {
    const HypothesisId& id = judged_->hypothesis.id;
    return ScoreInliers(problem_, judged_->test, thresholds(),
                        kScoresTheRest<Solver, PointTest> ? id.sample : Sample());
  }

 private:
  const MotionProblem& problem_;
  BlockSearch<Solver> fast_, models_;  // the second one for single models, which ends its loop
  std::optional<Judged<Solver, PointTest>> judged_;
};

// The decision of prcme and rcme, by mean entropy.
class EntropyDecision {
 public:
  EntropyDecision(const RansacOptions& options, const Thresholds& thresholds)
      : quality_test_(options.quality_test), normal_quantile_(thresholds.normal) {}
  bool AcceptsInlierSet(double z) const { return PassesQualityTest(z, normal_quantile_, quality_test_); }
  DecidingScore deciding_score() const { return DecidingScore::kMeanEntropy; }

 private:
  QualityTest quality_test_;
  double normal_quantile_;
};

template <LoopDecision Decision, typename PointTest>
LoopResult RunOverModels(const RansacOptions& options, const MotionProblem& problem, std::uint32_t trial) {
  const MatchBlocks matches(problem);
  RandomStream rng = SamplingStream(trial);
  SearchOfGivenModels<FivePoint, PointTest> search(problem, matches, options, rng);
  return RunRansacLoop(options, matches.num_matches(), search, search,
                       Decision(options, search.thresholds()));
}

// Of a variant with five points.
inline LoopResult ReferenceOverFastModels(const Variant& variant, const MotionProblem& problem,
                                          std::uint32_t trial) {
  const RansacOptions options = variant.Options();
  if (variant.estimator == "standard")
    return RunOverModels<InlierCountDecision, KnownPoseTest>(options, problem, trial);
  return variant.reading == Reading::kRankAware
             ? RunOverModels<EntropyDecision, RankAwareTest>(options, problem, trial)
             : RunOverModels<EntropyDecision, AsPrintedTest>(options, problem, trial);
}

}  // namespace rcme::agreement
