#include "experiments/audit/claims/claim_table.h"

#include "experiments/audit/claims/families.h"

namespace rcme {

std::vector<Claim> AllClaims(const std::vector<EstimatorEntry>& registry) {
  std::vector<EstimatorEntry> estimators, peers;
  for (const EstimatorEntry& entry : registry) {
    if (entry.is_audited) (entry.is_peer ? peers : estimators).push_back(entry);
  }
  std::vector<Claim> all;
  for (const std::vector<Claim>& family :
       {SigmaFClaims(), SigmaPClaims(), MleClaims(), SampsonClaims(), InlierClaims(), SampleTestClaims(),
        EntropyClaims(), ZTestClaims(), MuClaims(), FlagClaims(), FailureClaims(estimators),
        EarlyStopClaims(), ComplexityClaims(), EstimatorClaims(estimators), PeerClaims(peers)}) {
    all.insert(all.end(), family.begin(), family.end());
  }
  return all;
}

}  // namespace rcme
