// Posterior of a camera's faults: how probable each is, which to remove and how uncertain the camera is then.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace rcme {

// Joint least-squares estimates of k faults, their covariance, and the size each may have. A fault below
// `nominal` does not matter; one above `greatest` is not plausible for a camera that has been calibrated.
struct FaultEvidence {
  Eigen::VectorXd estimates;   // k x 1
  Eigen::MatrixXd covariance;  // k x k
  Eigen::VectorXd nominal, greatest;
};

struct FaultPosterior {
  std::vector<double> probabilities;  // that each fault exists
  Eigen::VectorXd mean;               // k x 1
  Eigen::MatrixXd covariance;         // k x k
};

// Bayesian model averaging. A model states which faults exist, S, and how large they are, s. The estimates
// are N(theta, V), theta_j ~ N(0, t_j^2) for j in S with t_j from three times the nominal to the greatest
// size in seven steps of equal ratio (6 s = 0 ... 6), and theta_j = 0 for the others. With T = diag(t^2)
//
//   p(estimates | S, s) = N(0, V + T),   E[theta] = T (V + T)^-1 estimates,   Cov[theta] = T - T (V + T)^-1 T
//
// The prior probability of no fault at all is 1/2. The other half is divided evenly among the numbers |S| = 1
// ... k, each share evenly among the sets of that number (Scott and Berger 2010: a search among more faults
// makes none more probable), and each of these among the sizes in proportion to 1 / t^2. These are the tails
// of Student's law with two degrees of freedom: large faults are rare, but not shrunk towards zero if the
// pairs show them. With strong evidence the prior does not matter: the posterior is that of the estimates,
// with the absent faults zero. Without evidence the stated camera is kept, with the prior's uncertainty,
// whose root mean square is some four times the nominal.
FaultPosterior InferFaults(const FaultEvidence& evidence);

// The correction to apply, k x 1: the posterior mean for faults with probability above 1/2 (the median
// probability model, Barbieri and Berger 2004), 0 for the others.
Eigen::VectorXd ChooseRemoved(const FaultPosterior& posterior);

// E[(theta - removed) (theta - removed)'], k x k: the uncertainty of the camera after the correction.
Eigen::MatrixXd ComputeUncertainty(const FaultPosterior& posterior, const Eigen::VectorXd& removed);

}  // namespace rcme
