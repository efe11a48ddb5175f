// The second reference of the validity map. It answers whether first order fails because the problem is
// nonlinear, or because its formula is wrong. For fixed samples, the covariance of the same estimator is also
// found in two ways that use none of its derivatives. All covariances are tested on the same fresh draws of
// noise.
//
//   first_order_at_estimate  G D G' and J_p G D G' J_p' at the noisy sample, a new one for each draw: what is
//                            available in practice. Its region lies in the tangent at the estimate.
//   first_order_at_truth     the same formula at the noise-free sample, one for all draws
//   unscented_at_truth       spread of the estimates from 8 m sigma points around the noise-free sample
//   monte_carlo_at_truth     covariance of the estimates from thousands of noises other than the fresh ones
//
// The last three lie in the tangent at the truth, so that they differ only in the covariance. If the formula
// is right, first_order_at_truth agrees with the other two at small noise. If all three at the truth cover
// and first_order_at_estimate does not, the cause is the evaluation at the estimate. If not even the
// Monte-Carlo covariance covers 0.95, the errors are biased or far from Gaussian, and no covariance can
// cover.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "experiments/core/table/table.h"

namespace rcme {

struct ValidityReferenceOptions {
  std::vector<double> sigmas_px = {0.1, 0.5};
  std::vector<int> nums_points = {8, 20, 100};
  double baseline_m = 0.5;
  int num_samples = 100;   // fixed noise-free samples per cell
  int num_draws = 100;     // fresh draws of noise per sample
  int num_noises = 2'000;  // draws for each Monte-Carlo covariance
  std::uint64_t seed = 1;
};

// How often a region covered, [f or pose][covariance].
using CoveredCounts = std::array<std::array<std::int64_t, 4>, 2>;

// A cell is a number of points with a noise level, which varies fastest.
std::int64_t NumCells(const ValidityReferenceOptions& options);
// The counts of one sample of a cell.
CoveredCounts CountCovered(const ValidityReferenceOptions& options, std::uint32_t cell, std::uint32_t sample);

// validity_reference.csv: one row per cell, quantity and covariance. n is num_samples x num_draws. The exact
// 95 % interval is that of the mean coverage over these samples, not over all samples of the family.
// `counts_of` returns the counts of all samples of a cell.
using CountsOfCell = std::function<CoveredCounts(std::uint32_t cell)>;
Table MakeValidityReferenceTable(const ValidityReferenceOptions& options, const CountsOfCell& counts_of);

}  // namespace rcme
