// What the check of the model makes of the posterior's probability of failure and of the covariance.
//
//   logit P = max(b_1 + sum_k b_k c_k, 0.02) l + b_0 + b_2 p + sum_m b_m c_m,   l = logit p
//
// p is the probability by the modes, c the quantities of the check (model_check.h; which ones:
// check_terms.h). The first sum tempers the log-odds: evidence of matches whose errors go together, that lie
// close to each other, on a plane, or of which few hold the parallax, is worth less than its nats. The other
// terms are what may be wrong although the modes do not know it. The covariance of a mode, where it is a
// sandwich, grows by exp(sum a_k y_k) where that exceeds 1.
//
// b is a logistic regression of failure, a the regression of the 0.95 quantile of NEES, on trials of a
// population of conditions and of the families; scripts/fit_calibrated makes both (fitted_constants.h).
#pragma once

#include <string>
#include <vector>

#include "estimator/calibrated/model_check.h"

namespace rcme {

// What the constants are weights of, as the fit sees it.
struct FitTerm {
  std::string name;
  double value;
};
// 1, l, p, then l c_k, then c_m.
std::vector<FitTerm> ListFailureTerms(double posterior, const ModelCheck& check);
// y.
std::vector<FitTerm> ListSpreadTerms(const ModelCheck& check);

// Of the default failure bounds, 3 and 15 deg. Grows with `posterior` whatever the check says.
double CheckedFailureProbability(double posterior, const ModelCheck& check);
// Whether every term lies where it did in all but the lowest and the highest 0.5 % of the trials that the
// constants were fitted to.
bool IsInDomain(double posterior, const ModelCheck& check);
// At least 1.
double CovarianceFactor(const ModelCheck& check);

}  // namespace rcme
