#include "estimator/kernels/block_search.h"

#include <cmath>

namespace rcme {
namespace {

// Degrees of freedom of the point test and of the sample test.
struct TestDof {
  int point, sample;
};

template <typename PointTest>
TestDof FindTestDof(int solver_dof) {
  return {PointTest::kDegreesOfFreedom, PointTest::SampleTestDof(solver_dof)};
}

TestDof DegreesOfFreedom(BlockReading reading, int solver_dof) {
  switch (reading) {
    case BlockReading::kAsPrinted:
      return FindTestDof<AsPrintedTest>(solver_dof);
    case BlockReading::kRankAware:
      return FindTestDof<RankAwareTest>(solver_dof);
    case BlockReading::kKnownPose:
      break;
  }
  return FindTestDof<KnownPoseTest>(solver_dof);
}

}  // namespace

template <typename Solver>
BlockSearch<Solver>::BlockSearch(const MotionProblem& problem, const MatchBlocks& matches,
                                 const RansacOptions& options, const BlockTests& tests, RandomStream& rng)
    : problem_(problem), matches_(matches), tests_(tests), rng_(rng), scan_(matches) {
  const TestDof dof = DegreesOfFreedom(tests.reading, Solver::kSampleTestDof);
  thresholds_ = Thresholds::For(problem, options, dof.point, dof.sample);
  tests_.tests_sample = tests.tests_sample && Solver::kSampleTestDof > 0;
  // As printed, h is the entropy of a 4-dimensional density in px: 1/2 log((2 pi e)^4 det), det in px^8
  // (eq. 15).
  if (tests.reading == BlockReading::kAsPrinted) {
    entropy_offset_ = AsPrintedTest::EntropyOfLogDeterminant(8.0 * std::log(problem.sigma_px));
  }
}

template <typename Solver>
RequestedOutputs BlockSearch<Solver>::OutputsOfModels() const {
  const bool needs_misfit = tests_.tests_sample && tests_.reading == BlockReading::kRankAware;
  return tests_.reading == BlockReading::kKnownPose ? RequestedOutputs::kNone
         : needs_misfit                             ? RequestedOutputs::kCovarianceAndMisfit
                                                    : RequestedOutputs::kCovariance;
}

template <typename Solver>
std::uint8_t BlockSearch<Solver>::FindConsistent() const {
  if (!tests_.tests_sample) return 0xff;
  if (tests_.reading == BlockReading::kAsPrinted) return FindConsistentSamples(block_, thresholds_.sample);
  unsigned consistent = 0;
  for (int lane = 0; lane < kBlockSize; ++lane) {
    consistent |= static_cast<unsigned>(block_.sample_statistic[lane] <= thresholds_.sample) << lane;
  }
  return static_cast<std::uint8_t>(consistent);
}

template <typename Solver>
Proposal BlockSearch<Solver>::Next() {
  if (++lane_ == kBlockSize) {
    source_.FillNext(matches_, OutputsOfModels(), rng_, &block_, &proposals_);
    is_consistent_ = FindConsistent();
    lane_ = 0;
  }
  Proposal proposal = proposals_[static_cast<size_t>(lane_)];
  if (block_.is_model >> lane_ & 1) {
    proposal.verdict =
        is_consistent_ >> lane_ & 1 ? SampleVerdict::kConsistent : SampleVerdict::kInconsistent;
  }
  return proposal;
}

template <typename Solver>
InlierScore BlockSearch<Solver>::Score() {
  const bool scores_the_rest =
      tests_.reading == BlockReading::kAsPrinted && kScoresTheRest<Solver, AsPrintedTest>;
  return ScoreLane(lane_, scores_the_rest ? proposals_[static_cast<size_t>(lane_)].id.sample : Sample());
}

template <typename Solver>
InlierScore BlockSearch<Solver>::ScoreLane(int lane, const Sample& left_out) {
  if (tests_.reading == BlockReading::kKnownPose) {
    double F[9];
    for (int i = 0; i < 9; ++i) F[i] = block_.F[i][lane];
    ScanKnownPose(matches_, F, thresholds_.point, &scan_);
    return {.num_inliers = scan_.num_inliers};
  }
  const WhitenedModel model(block_, lane);
  if (tests_.reading == BlockReading::kAsPrinted) {
    ScanAsPrinted(matches_, model, thresholds_.point, &scan_);
    RemoveSample(left_out, &scan_);
    return SummarizeEntropies(scan_, entropy_offset_);
  }
  const VariancePolynomial variance(model.dF);
  ScanRankAware(matches_, model.F, variance, thresholds_.point, &scan_);
  InlierScore score = SummarizeEntropies(scan_, entropy_offset_);
  if (tests_.needs_likelihood) {
    score.negative_log_likelihood =
        NegativeLogLikelihood(matches_, model.F, variance, thresholds_.outlier_cost);
  }
  return score;
}

template <typename Solver>
std::optional<Hypothesis<Solver>> BlockSearch<Solver>::FindHypothesis(const HypothesisId& id) {
  lane_ = kBlockSize - 1;  // the block holds no proposals any more
  return source_.FindHypothesis(problem_, matches_, id);
}

template <typename Solver>
const MatchMask& BlockSearch<Solver>::FindSupport(const HypothesisId& id) {
  source_.FillFirst(matches_, OutputsOfModels(), id, &block_);
  ScoreLane(0, {});
  lane_ = kBlockSize - 1;  // the block holds no proposals any more
  return scan_.inliers;
}

template class BlockSearch<EightPoint>;
template class BlockSearch<FivePoint>;

}  // namespace rcme
