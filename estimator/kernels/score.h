// Scores one hypothesis against all matches: which are inliers (eq::find-inlier), and how uncertain they are
// (eq::score-inliers). The same tests as point_consistency.h, many matches at a time.
#pragma once

#include <optional>

#include "estimator/geometry/pose.h"
#include "estimator/inlier_quality.h"
#include "estimator/kernels/hypothesis_block.h"
#include "estimator/sample.h"

namespace rcme {

// A motion with its covariance in whitened coordinates, from a block of hypotheses or any other.
struct WhitenedModel {
  double F[9];
  double dF[5][9];

  // Leaves dF unset if the block's RequestedOutputs is kNone.
  WhitenedModel(const HypothesisBlock& block, int hypothesis);
  // Nullopt if pose_cov is not finite and positive semi-definite.
  static std::optional<WhitenedModel> From(const MatchBlocks& matches, const RelativePose& pose,
                                           const Matrix5d& pose_cov);

 private:
  WhitenedModel() = default;
};

// The variance that the motion adds to g, sum_k (x2' dF_k x1)^2, as a polynomial: coefficient 6 a + b belongs
// to the a-th monomial of image 2 and the b-th of image 1 in the order x^2, xy, x, y^2, y, 1.
struct VariancePolynomial {
  double coefficients[36];
  explicit VariancePolynomial(const double (&dF)[5][9]);
};

// The result of a pass over the matches. The caller keeps it from one hypothesis to the next, so that only
// the first one allocates memory.
struct InlierScan {
  explicit InlierScan(const MatchBlocks& matches)
      : inliers(matches.Empty()), spreads(inliers.size() * kBlockSize + kBlockSize) {}
  MatchMask inliers;
  int num_inliers = 0;
  std::vector<double> spreads;  // of the inliers in ascending order: det Sigma_delta / sigma^8 (as printed),
                                // s2 / sigma^2 (rank-aware)
};

// Finds the inliers d2 = g^2 / n2 <= threshold, with the motion taken as exact.
void ScanKnownPose(const MatchBlocks& matches, const double* F, double threshold, InlierScan* scan);
// Finds the inliers d2 <= threshold, d2 of printed_distance-inl.h.
void ScanAsPrinted(const MatchBlocks& matches, const WhitenedModel& model, double threshold,
                   InlierScan* scan);
// Finds the inliers d2 = g^2 / (n2 + variance of g due to the motion) <= threshold.
void ScanRankAware(const MatchBlocks& matches, const double* F, const VariancePolynomial& variance,
                   double threshold, InlierScan* scan);

// Removes those matches of a sample that are inliers, and their spreads, from the scan.
void RemoveSample(const Sample& sample, InlierScan* scan);

// Summarises the entropies h = log(spread) / 2 + offset of the inliers (eq. 15) by psi and s (eq. 16).
InlierScore SummarizeEntropies(const InlierScan& scan, double offset);

// Predictive likelihood, rank-aware: the sum over all matches of
//
//   min(outlier_cost, (d2 + log(2 pi s2 / sigma^2)) / 2)
double NegativeLogLikelihood(const MatchBlocks& matches, const double* F, const VariancePolynomial& variance,
                             double outlier_cost);

// Bit l: every match of sample l is within the printed threshold (eq. 12) of its own hypothesis
// (eq::sample-p-test).
std::uint8_t FindConsistentSamples(const HypothesisBlock& block, double threshold);

}  // namespace rcme
