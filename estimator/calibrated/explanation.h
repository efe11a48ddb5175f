// What a mode says of every match: the density of its residual, whether it is right, and its influence.
#pragma once

#include <vector>

#include "estimator/calibrated/mode.h"
#include "estimator/kernels/mixture_sums.h"

namespace rcme {

// Residuals are r', and densities those of r' (mixture_parameters.h).
struct Explanation {
  MatchTermLists terms;
  std::vector<double> inlier_density;  // f(r / s) c(z / s) / s
  std::vector<double> probability;     // that the match is right
  // a = p v J H^-1 J' / s^2, at most 1: the share of a match's residual that the motion follows; a / (1 + a),
  // what it would be, of a match that the mode does not use.
  std::vector<double> leverage;
  // The density of the residual r' that the motion fitted without the match leaves, whose standard deviation
  // is s / sqrt(1 - h): r' = r / (1 - h), or r where the mode does not use the match.
  std::vector<double> left_out_density;
  std::vector<double> noise_scale;  // w_i (mixture_parameters.h); empty: all matches are alike
  int num_explained = 0;            // matches that are right with a probability of more than one half
};

// The density of r' of match i if it is wrong, `per_sigma` that of r.
inline double WrongDensity(const Explanation& explanation, size_t i, double per_sigma) {
  return explanation.noise_scale.empty() ? per_sigma : per_sigma * explanation.noise_scale[i];
}

// One entry per match.
Explanation Explain(const MatchBlocks& matches, const Mode& mode);

// f(u) of the noise law.
double NoiseDensity(const NoiseLaw& noise, double u);
// v = 2k / (2k - 1 + u^2)
double NoiseWeight(const NoiseLaw& noise, double u);

}  // namespace rcme
