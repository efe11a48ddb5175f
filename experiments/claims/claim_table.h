#pragma once

#include "estimator/estimator_registry.h"
#include "experiments/claims/claim.h"

namespace rcme {

// Every claim, family by family; `estimators` are those whose reported covariances are checked.
std::vector<Claim> AllClaims(const std::vector<EstimatorEntry>& estimators);

}  // namespace rcme
