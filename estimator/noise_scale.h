// How noisy each match is, beside sigma_px (MotionProblem::noise_scale).
#pragma once

#include <vector>

#include "estimator/motion_problem.h"

namespace rcme {

// Beyond a factor of a million nothing is said about noise, and products of four would overflow long after.
inline constexpr double kMaxNoiseScale = 1e6;

// Of match i; 1 where all are alike.
inline double NoiseScaleAt(const MotionProblem& problem, size_t i) {
  return problem.noise_scale.empty() ? 1.0 : problem.noise_scale[i];
}

// Of matches whose own standard deviations somebody states (any unit, all above 0; empty: nobody does): each
// over their median. Only their relation is kept: how large noise is in all is assumed (sigma_px) or
// estimated.
std::vector<double> ComputeNoiseScale(std::vector<double> sigmas);

// The problem with these of its matches, in this order; `which` holds indices.
template <typename Indices>
MotionProblem SelectPart(const MotionProblem& problem, const Indices& which) {
  MotionProblem part{{}, problem.camera1, problem.camera2, problem.sigma_px, {}, problem.prior};
  for (const auto index : which) {
    const auto i = static_cast<size_t>(index);
    part.matches.push_back(problem.matches[i]);
    if (!problem.noise_scale.empty()) part.noise_scale.push_back(problem.noise_scale[i]);
  }
  return part;
}

}  // namespace rcme
