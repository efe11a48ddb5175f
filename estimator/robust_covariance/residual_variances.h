// What the variance of residuals is made of: how much of it is each match's own, how much is shared by the
// matches of one key point, how much by neighbours; and what it makes of a least-squares motion's covariance.
//
// The errors of key points are isotropic in each image, those of two that are d apart correlated as a mixture
// of exponentials, which is a covariance function whatever the weights v_k >= 0. The residuals r = g / (sigma
// |J|) of two matches i, j have then the covariance
//
//   V_ij = v_0 [i = j] + v_1 [same key point] + sum_k v_k c_ij(l_k),   l = 30, 90, 270 px
//   c_ij(l) = u_i1' u_j1 exp(-d_ij1 / l) + u_i2' u_j2 exp(-d_ij2 / l)
//
// u_i = J' / |J| (4x1, its halves those of the two images: the normals of the epipolar lines), so that c_ii =
// 1; all matches of a key point are taken to be where its first is. With the residuals' derivatives J_i (1x5)
// along the motion and A = sum J_i' J_i the motion has the covariance A^-1 (sum_ij V_ij J_i' J_j) A^-1, a
// sandwich whose kernel is estimated (Conley 1999 has a given one).
//
// The v are those of least residuals of the moments (Haseman and Elston 1972), q = T v,
//
//   q_0 = sum over key points of the mean r_i^2          W_0
//   q_1 = sum over key points of the mean r_i r_j, i /= j  W_1
//   q_k = sum over pairs of key points g, h of c_gh(l_k) times their mean residuals' product  W_k
//
// each a quadratic form r' W_a r, so that T_ab = tr(W_a P K_b P) with the projection P = I - U U' of the five
// parameters that were fitted, U = J A^-1/2, K_b the matrix that v_b stands before. A key point counts once,
// however often it is matched: one that is matched fifty times would else decide alone. Weighted by M_ab =
// tr(W_a W_b), the covariance of q / sqrt(2) where the residuals are independent; v >= 0, of all subsets of
// the parts the best.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "estimator/robust_covariance/clustered_covariance.h"

namespace rcme {

struct ResidualVariances {
  double own = 1.0;                    // v_0
  double of_key_point = 0.0;           // v_1
  std::vector<double> of_neighbours;   // v_k by length
  double deviance = 0.0;               // by which these are better than v_0 alone
  Matrix5d shared = Matrix5d::Zero();  // A^-1 (sum_ij (V_ij - v_0 [i = j]) J_i' J_j) A^-1

  double Sum() const;
};

// `groups` numbers the key point of each match (KeyPointGroups). All is own where the parts that are shared
// do not lower the deviance by more than 1; parts of which there are no two matches are zero. With more than
// 1,500 key points, 1,500 of them stand for all.
ResidualVariances FitResidualVariances(const MatchScores& scores, std::span<const int> groups);

inline constexpr double kKeyPointRadiusPx = 1.0;  // within which matches share a key point
inline constexpr std::array<double, 3> kNeighbourLengthsPx = {30.0, 90.0, 270.0};
inline constexpr int kNumVarianceParts = 5;  // own, of a key point, of neighbours by length

// The equations of the moments: q = T v with weights M, and what a v of 1 adds to the middle of the sandwich.
// They are the same of several motions together: sums of q, T and M (camera_noise/shared_variance.h).
struct ResidualMoments {
  using Parts = Eigen::Matrix<double, kNumVarianceParts, 1>;
  using PartsSquare = Eigen::Matrix<double, kNumVarianceParts, kNumVarianceParts>;
  Parts q = Parts::Zero();
  PartsSquare T = PartsSquare::Zero(), M = PartsSquare::Zero();
  std::array<Matrix5d, kNumVarianceParts> G;  // U' K_b U
};
// Nothing where the matches do not determine the motion. Lengths are kNeighbourLengthsPx times `unit_px`,
// that of 1 px.
std::optional<ResidualMoments> ComputeResidualMoments(const MatchScores& scores, std::span<const int> groups,
                                                      double unit_px = 1.0);

// Variances that are known beforehand, over sigma^2: one length of neighbours.
struct KnownVariances {
  double own = 1.0, of_key_point = 0.0, of_neighbours = 0.0;
  double length_px = kNeighbourLengthsPx.back();
};
// The same as of a fit, of these variances in place of the residuals' own.
ResidualVariances TakeResidualVariances(const MatchScores& scores, std::span<const int> groups,
                                        const KnownVariances& known);

}  // namespace rcme
