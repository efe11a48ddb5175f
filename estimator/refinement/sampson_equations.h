// The normal equations of the Sampson distance, one match at a time, in pixels. The fast implementation is
// kernels/sampson_equations.h; the two share no formula.
#pragma once

#include <array>
#include <span>

#include "estimator/motion_problem.h"
#include "estimator/refinement/motion_search.h"

namespace rcme {

// The residual of one match at a motion and its derivatives along the five coordinates of the motion.
struct SampsonResidual {
  double r = 0.0;     // g / (sigma |J|), sigma that of the match
  double norm = 0.0;  // sigma |J|
  Vector5d g_p;       // derivatives of g
  Vector5d r_p;       // derivatives of r
};
// The same without the derivatives of r, which take most of the time.
struct SampsonScore {
  double r = 0.0;            // g / (sigma |J|)
  double norm = 0.0;         // sigma |J|
  Vector5d g_p;              // derivatives of g
  Eigen::Vector4d gradient;  // J'
};
class SampsonLinearization {
 public:
  SampsonLinearization(const MotionProblem& problem, const RelativePose& pose);
  // For a match with sigma = sigma_px * noise_scale.
  SampsonResidual Evaluate(const Correspondence& match, double noise_scale = 1.0) const;
  SampsonScore Score(const Correspondence& match, double noise_scale = 1.0) const;

 private:
  double sigma_px_;
  Eigen::Matrix3d F_;
  std::array<Eigen::Matrix3d, 5> dF_;  // px
};

// The equations of sum rho(r^2) / 2 over the matches `indices` at a motion, r = g / (sigma |J|). The
// derivative of r along coordinate k of the motion is (g_k - r sigma J J_k' / |J|) / (sigma |J|), g_k and J_k
// the derivatives of g and J.
NormalEquations LinearizeSampson(const MotionProblem& problem, std::span<const int> indices,
                                 const RelativePose& pose, Loss loss);

// sum g_p' g_p / var g over the matches, var g = sigma^2 |J|^2, sigma that of the match: 5x5, [rotation,
// direction], 1 / rad^2.
Matrix5d SampsonInformation(const MotionProblem& problem, std::span<const int> indices,
                            const RelativePose& pose);

}  // namespace rcme
