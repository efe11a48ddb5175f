#pragma once

#include "estimator/estimator_registry.h"
#include "experiments/audit/claims/claim.h"

namespace rcme {

// Every claim, family by family. `estimators` are checked as black boxes: the covariances they report, and
// those that the paper does not know for their failures against standard.
std::vector<Claim> AllClaims(const std::vector<EstimatorEntry>& estimators);

}  // namespace rcme
