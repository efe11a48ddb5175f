#include "estimator/kernels/block_search.h"

#include <cmath>

namespace rcme {
namespace {

int DegreesOfFreedom(BlockSearch::Reading reading) {
  switch (reading) {
    case BlockSearch::Reading::kAsPrinted:
      return AsPrintedTest::kDegreesOfFreedom;
    case BlockSearch::Reading::kRankAware:
      return RankAwareTest::kDegreesOfFreedom;
    case BlockSearch::Reading::kKnownPose:
      break;
  }
  return KnownPoseTest::kDegreesOfFreedom;
}

}  // namespace

BlockSearch::BlockSearch(const MotionProblem& problem, const MatchBlocks& matches,
                         const RansacOptions& options, const Tests& tests, RandomStream& rng)
    : matches_(matches),
      tests_(tests),
      thresholds_(Thresholds::For(problem, options, DegreesOfFreedom(tests.reading))),
      rng_(rng),
      scan_(matches) {
  // As printed, h is of a 4-dimensional density in px: 1/2 log((2 pi e)^4 det), det in px^8.
  if (tests.reading == Reading::kAsPrinted) {
    entropy_offset_ = AsPrintedTest::EntropyOfLogDeterminant(8.0 * std::log(problem.sigma_px));
  }
}

void BlockSearch::InstantiateSamples() {
  const bool needs_misfit = tests_.tests_sample && tests_.reading == Reading::kRankAware;
  const Spread spread = tests_.reading == Reading::kKnownPose ? Spread::kNone
                        : needs_misfit                        ? Spread::kCovarianceAndMisfit
                                                              : Spread::kCovariance;
  InstantiateModels(matches_, samples_, spread, &block_);
}

std::uint8_t BlockSearch::FindConsistent() const {
  if (!tests_.tests_sample) return 0xff;
  if (tests_.reading == Reading::kAsPrinted) return FindConsistentSamples(block_, thresholds_.sample);
  unsigned consistent = 0;
  for (int lane = 0; lane < kBlockSize; ++lane) {
    consistent |= static_cast<unsigned>(block_.sample_statistic[lane] <= thresholds_.sample) << lane;
  }
  return static_cast<std::uint8_t>(consistent);
}

Proposal BlockSearch::Next() {
  if (++lane_ == kBlockSize) {
    for (Sample& sample : samples_) sample = DrawSample(matches_.num_matches(), rng_);
    InstantiateSamples();
    is_consistent_ = FindConsistent();
    lane_ = 0;
  }
  Proposal proposal{samples_[static_cast<size_t>(lane_)]};
  if (block_.is_model >> lane_ & 1) {
    proposal.verdict =
        is_consistent_ >> lane_ & 1 ? SampleVerdict::kConsistent : SampleVerdict::kInconsistent;
  }
  return proposal;
}

InlierScore BlockSearch::Score() { return ScoreLane(lane_); }

InlierScore BlockSearch::ScoreLane(int lane) {
  if (tests_.reading == Reading::kKnownPose) {
    double F[9];
    for (int i = 0; i < 9; ++i) F[i] = block_.F[i][lane];
    ScanKnownPose(matches_, F, thresholds_.point, &scan_);
    return {.num_inliers = scan_.num_inliers};
  }
  const WhitenedModel model(block_, lane);
  if (tests_.reading == Reading::kAsPrinted) {
    ScanAsPrinted(matches_, model, thresholds_.point, &scan_);
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

const MatchMask& BlockSearch::FindSupport(const Sample& sample) {
  samples_.fill(sample);
  InstantiateSamples();
  ScoreLane(0);
  lane_ = kBlockSize - 1;  // the block holds no proposals any more
  return scan_.inliers;
}

}  // namespace rcme
