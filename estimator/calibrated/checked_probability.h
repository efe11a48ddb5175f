// Corrects the posterior's probability of failure and the covariance by the model check.
//
//   logit P = b_0 + max(b_1 + sum_k c_k h_k(x), 0.02) l + b_2 p + sum_m d_m h_m(x),   l = logit p
//
// Here p is the probability of failure according to the modes and x the indicators (kCheckSigns in the .cc),
// each clipped to its range in the trials of the fit. A term h is a hinge max(s (x_i - t), 0) with s = 1 or
// -1, or the product of two hinges: multivariate adaptive regression splines (Friedman 1991, Annals of
// Statistics 19:1).
//
// The first sum tempers the log-odds: if the errors of matches depend on each other, or if a few matches
// decide the motion, evidence is worth less than its nats. The other terms describe errors that the modes
// cannot see. The covariance of a mode, if it is a sandwich, is multiplied by max(exp(sum a_k y_k), 1).
//
// scripts/fit_calibrated makes the constants (fitted_constants.h) on trials of a population of conditions and
// of families of scenes. A logistic regression of failure selects the terms h and finds their weights; a
// regression of the 0.95 quantile of NEES finds a.
#pragma once

#include <string>
#include <vector>

#include "estimator/calibrated/model_check.h"

namespace rcme {

// An input of the fit.
struct FitTerm {
  std::string name;
  double value;
};
std::vector<FitTerm> ListCheckSigns(const ModelCheck& check);       // x
std::vector<FitTerm> ListCovarianceSigns(const ModelCheck& check);  // y

// P for the default failure bounds, 3 and 15 deg. It increases with `posterior` for every result of the
// check.
double CheckedFailureProbability(double posterior, const ModelCheck& check);
// Whether the posterior and every indicator lie within the central 99 % of the trials of the fit.
bool IsInDomain(double posterior, const ModelCheck& check);
// The factor of the covariance, at least 1.
double CovarianceFactor(const ModelCheck& check);

}  // namespace rcme
