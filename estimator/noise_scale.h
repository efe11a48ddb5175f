// The noise of each match relative to sigma_px (MotionProblem::noise_scale).
#pragma once

#include <vector>

#include "estimator/motion_problem.h"

namespace rcme {

// Bound that keeps products of four scales far from overflow; no statement about noise needs a larger factor.
inline constexpr double kMaxNoiseScale = 1e6;

// The noise scale of match i; 1 if the problem has none.
inline double NoiseScaleAt(const MotionProblem& problem, size_t i) {
  return problem.noise_scale.empty() ? 1.0 : problem.noise_scale[i];
}

// A noise level of the problem's pixels in those of the images as they were taken, px.
inline double InImagePixels(const MotionProblem& problem, double sigma_px) {
  return problem.undistortion ? sigma_px / problem.undistortion->noise_growth : sigma_px;
}

// Stated standard deviations (any unit, all > 0) divided by their median; empty if empty. Only the ratios
// matter: the noise level itself is assumed (sigma_px) or estimated.
std::vector<double> ComputeNoiseScale(std::vector<double> sigmas);

// The problem with only the matches at the indices `which`, in this order.
template <typename Indices>
MotionProblem SelectPart(const MotionProblem& problem, const Indices& which) {
  MotionProblem part{{}, problem.camera1, problem.camera2, problem.sigma_px, {}, problem.prior};
  part.undistortion = problem.undistortion;
  for (const auto index : which) {
    const auto i = static_cast<size_t>(index);
    part.matches.push_back(problem.matches[i]);
    if (!problem.noise_scale.empty()) part.noise_scale.push_back(problem.noise_scale[i]);
    if (!problem.match_quality.empty()) part.match_quality.push_back(problem.match_quality[i]);
  }
  return part;
}

}  // namespace rcme
