// What the check of the model makes of the posterior's probability of failure and of the covariance.
//
//   logit P = b_0 + max(b_1 + sum_k c_k h_k(x), 0.02) l + b_2 p + sum_m d_m h_m(x),   l = logit p
//
// p is the probability by the modes, x the signs of the check (check_signs.h), each cut to the range that it
// had in the trials of the fit. h is max(s (x_i - t), 0), s = 1 or -1, or the product of two of these:
// multivariate adaptive regression splines (Friedman 1991, Annals of Statistics 19:1). The first sum tempers
// the log-odds: evidence of matches whose errors go together, or on which few decide, is worth less than its
// nats. The other terms are what may be wrong although the modes do not know it. The covariance of a mode,
// where it is a sandwich, grows by exp(sum a_k y_k) where that exceeds 1.
//
// The products are chosen, and their weights found, by a logistic regression of failure, a by a regression of
// the 0.95 quantile of NEES, on trials of a population of conditions and of the families;
// scripts/fit_calibrated makes both (fitted_constants.h).
#pragma once

#include <string>
#include <vector>

#include "estimator/calibrated/model_check.h"

namespace rcme {

// What the fit sees of an answer.
struct FitTerm {
  std::string name;
  double value;
};
std::vector<FitTerm> ListCheckSigns(const ModelCheck& check);       // x
std::vector<FitTerm> ListCovarianceSigns(const ModelCheck& check);  // y

// Of the default failure bounds, 3 and 15 deg. Grows with `posterior` whatever the check says.
double CheckedFailureProbability(double posterior, const ModelCheck& check);
// Whether every sign lies where it did in all but the lowest and the highest 0.5 % of the trials that the
// constants were fitted to, and the posterior as well.
bool IsInDomain(double posterior, const ModelCheck& check);
// At least 1.
double CovarianceFactor(const ModelCheck& check);

}  // namespace rcme
