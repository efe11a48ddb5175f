// The claims, one function per family.
#pragma once

#include "estimator/estimator_registry.h"
#include "experiments/audit/claims/claim.h"

namespace rcme {

std::vector<Claim> SigmaFClaims();      // covariance of f
std::vector<Claim> SigmaPClaims();      // covariance of the motion
std::vector<Claim> MleClaims();         // covariance of the refined motion
std::vector<Claim> SampsonClaims();     // covariance of the Sampson vector
std::vector<Claim> InlierClaims();      // test of a point against a motion
std::vector<Claim> SampleTestClaims();  // test of a motion against its own sample
std::vector<Claim> EntropyClaims();     // what the entropy of an inlier set measures
std::vector<Claim> ZTestClaims();       // the test of the mean entropy
std::vector<Claim> MuClaims();          // its threshold
std::vector<Claim> FlagClaims();        // the failure flag
std::vector<Claim> ComplexityClaims();
// Comparisons of failure rates: the paper's three, and every other estimator against standard.
std::vector<Claim> FailureClaims(const std::vector<EstimatorEntry>& estimators);
std::vector<Claim> EarlyStopClaims();
// Any estimator, as a black box.
std::vector<Claim> EstimatorClaims(const std::vector<EstimatorEntry>& estimators);
// The assumptions of OpenCV's estimators; empty if these are not among the peers.
std::vector<Claim> PeerClaims(const std::vector<EstimatorEntry>& peers);

}  // namespace rcme
