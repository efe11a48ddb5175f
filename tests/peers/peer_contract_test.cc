// The peers are held to what every estimator is held to: the checks of `rcme check-estimator`, and of
// options.
#include <gtest/gtest.h>

#include "experiments/audit/contract/estimator_contract.h"
#include "tests/peers/peer_entries.h"
#include "tests/test_support/option_checks.h"

namespace rcme {
namespace {

TEST(PeerContract, IsKept) {
  for (const EstimatorEntry& entry : PeerEntries()) {
    for (const ContractCheck& check : ContractChecks()) {
      const ContractResult result =
          RunContractCheck(check.name, [&] { return MakeEstimator(entry.name); }, {});
      EXPECT_TRUE(result.has_passed) << entry.name << ", " << check.name << " on '" << result.problem
                                     << "': " << result.finding;
    }
  }
}

TEST(PeerOptions, EveryOneHasAnEffect) {
  for (const EstimatorEntry& entry : PeerEntries()) ExpectEveryOptionHasAnEffect(entry);
}

TEST(PeerOptions, DefaultsAreAllowedAndTextsGoRound) {
  for (const EstimatorEntry& entry : PeerEntries()) ExpectTextsGoRound(entry);
}

TEST(PeerOptions, WithoutLimitsAPeerHasValuesThatAreAllowed) {
  for (const EstimatorEntry& entry : PeerEntries()) ExpectAllowedWithoutLimits(entry);
}

}  // namespace
}  // namespace rcme
