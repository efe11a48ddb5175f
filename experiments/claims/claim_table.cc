#include "experiments/claims/claim_table.h"

#include <algorithm>
#include <functional>
#include <iterator>

#include "experiments/claims/families.h"

namespace rcme {

std::vector<Claim> AllClaims(const std::vector<EstimatorEntry>& registry) {
  std::vector<EstimatorEntry> estimators;
  std::ranges::copy_if(registry, std::back_inserter(estimators), std::not_fn(&EstimatorEntry::is_peer));
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
