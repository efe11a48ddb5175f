#pragma once

#include "estimator/estimator_registry.h"
#include "experiments/audit/claims/claim.h"

namespace rcme {

// Every claim, family by family. `estimators` are checked as black boxes: the covariances they report, and,
// for estimators that are not in the paper, their failures compared with standard.
std::vector<Claim> AllClaims(const std::vector<EstimatorEntry>& estimators);

}  // namespace rcme
