#include "experiments/claims/claim_table.h"

#include "experiments/claims/families.h"

namespace rcme {

std::vector<Claim> AllClaims(const std::vector<EstimatorEntry>& estimators) {
  std::vector<Claim> all;
  for (const std::vector<Claim>& family :
       {SigmaFClaims(), SigmaPClaims(), MleClaims(), SampsonClaims(), InlierClaims(), SampleTestClaims(),
        EntropyClaims(), ZTestClaims(), MuClaims(), FlagClaims(), FailureClaims(estimators),
        EarlyStopClaims(), ComplexityClaims(), EstimatorClaims(estimators)}) {
    all.insert(all.end(), family.begin(), family.end());
  }
  return all;
}

}  // namespace rcme
