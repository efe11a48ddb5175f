// How a mode explains each match: the density of its residual, the probability that it is an inlier, and its
// leverage.
#pragma once

#include <vector>

#include "estimator/calibrated/mode.h"
#include "estimator/kernels/mixture_sums.h"

namespace rcme {

// Residuals are r', and densities are those of r' (mixture_parameters.h). Every list has one entry per match.
struct Explanation {
  MatchTermLists terms;
  std::vector<double> inlier_density;  // f(r / s) c(z / s) / s
  std::vector<double> probability;     // that the match is an inlier
  // The share of a match's residual that the motion follows: min(a, 1) with a = p v J H^-1 J' / s^2. For a
  // match that the mode does not use: a / (1 + a), the leverage that it would have.
  std::vector<double> leverage;
  // The density of the residual r' that the match has under the motion fitted without it, whose standard
  // deviation is s / sqrt(1 - h). There r' = r / (1 - h), or r if the mode does not use the match.
  std::vector<double> left_out_density;
  std::vector<double> noise_scale;  // w_i (mixture_parameters.h); empty if all are 1
  int num_explained = 0;            // matches whose probability exceeds one half
  // The eighth root of the product of the determinants of the explained matches' scatters in the two images,
  // in whitened coordinates: about the radius of the area that they cover.
  double extent = 0.0;
};

// The density of r' of match i if it is an outlier; `per_sigma` is that of r.
inline double WrongDensity(const Explanation& explanation, size_t i, double per_sigma) {
  return explanation.noise_scale.empty() ? per_sigma : per_sigma * explanation.noise_scale[i];
}

// Explains the matches by the mode.
Explanation Explain(const MatchBlocks& matches, const Mode& mode);

// The density f(u).
double NoiseDensity(const NoiseLaw& noise, double u);
// The weight v = 2k / (2k - 1 + u^2).
double NoiseWeight(const NoiseLaw& noise, double u);

}  // namespace rcme
