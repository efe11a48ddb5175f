// How probable the faults of a camera are, what to take out, and how uncertain the camera is then.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace rcme {

// Of k faults: least-squares estimates beside each other, their covariance, and how large each may be. A
// fault of less than `nominal` is none that matters, one of more than `greatest` is none of a camera that
// somebody calibrated.
struct FaultEvidence {
  Eigen::VectorXd estimates;   // k x 1
  Eigen::MatrixXd covariance;  // k x k
  Eigen::VectorXd nominal, greatest;
};

struct FaultPosterior {
  std::vector<double> probabilities;  // of each fault being there
  Eigen::VectorXd mean;               // k x 1
  Eigen::MatrixXd covariance;         // k x k
};

// Bayesian model averaging. A model says which faults there are, S, and how large, s: the estimates are
// N(theta, V), theta_j ~ N(0, t_j^2) for j in S with t_j from three times the nominal to the greatest size in
// seven steps of equal ratio (six times s), and theta_j = 0 for the others. With T = diag(t^2)
//
//   p(estimates | S, s) = N(0, V + T),   E[theta] = T (V + T)^-1 estimates,   Cov[theta] = T - T (V + T)^-1 T
//
// The prior probability is 1/2 of no fault at all; the other half is shared evenly by the numbers |S| = 1 ...
// k, each of these by its sets (Scott and Berger 2010: searching among more faults makes none more probable),
// and each of these by its sizes in proportion to 1 / t^2, the tails of Student's law of two degrees of
// freedom: large faults are rare and, where the pairs show one, not drawn towards zero. Where the evidence is
// strong nothing else matters: the posterior is then that of the estimates, the faults that are not there
// taken to be zero. Where there is none the stated camera is believed but for the prior, whose root mean
// square is some four times the nominal.
FaultPosterior InferFaults(const FaultEvidence& evidence);

// What to take out, k x 1: of faults that are more probable than not (the median probability model, Barbieri
// and Berger 2004) the posterior mean, 0 of the others.
Eigen::VectorXd ChooseRemoved(const FaultPosterior& posterior);

// E[(theta - removed) (theta - removed)'], k x k: what is uncertain of the camera once that is taken out.
Eigen::MatrixXd ComputeUncertainty(const FaultPosterior& posterior, const Eigen::VectorXd& removed);

}  // namespace rcme
