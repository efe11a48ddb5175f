// A few parameters that all units (image pairs) of a set share, of which each unit tells a little.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

// Of one unit: where its own least squares would go, A^-1 s. Members as in shared_members.h: units that have
// one in common are not independent; equal members belong to that unit alone.
struct UnitScore {
  std::int64_t member1 = 0, member2 = 0;
  Eigen::VectorXd score;        // s, k x 1
  Eigen::MatrixXd information;  // A, k x k, positive semidefinite
};

struct PooledParameter {
  double value = 0.0;           // NaN: the units cannot tell it
  double standard_error = 0.0;  // NaN where there is no interval
  Interval interval;            // unbounded where one unit or member alone, or none, tells the parameter
  double effective_n = 0.0;     // units of equal weight that would tell as much
};

struct PooledScores {
  std::vector<PooledParameter> parameters;  // k; none without units
  double dispersion = 0.0;       // by how much units scatter more, in variance, than their A says; NaN of one
  double p_value = 1.0;          // of all parameters being zero, an F-test; NaN where it cannot be made
  Eigen::MatrixXd correlations;  // of the estimates, as the information says; empty where that is singular
};

// theta = A^-1 sum s_u, A = sum A_u. How sure that is the units say by their scatter, since errors that are
// correlated within a unit make its own A too great. Two estimates of the variance of theta_j:
//
//   V_j   a jackknife (CR3, Bell and McCaffrey 2002) over members: m / (m - 1) (sum over members d_ij^2 - sum
//         over units of two members d_uj^2), d_i = (A - A_i)^-1 sum (s_u - A_u theta) over the units that
//         have member i, A_i their information, d_u the same of one unit, d about their means: the sum over
//         (u, v) that share a member of d_uj d_vj (shared_members.h), but that leaving out a member moves
//         theta as far as its whole share. At least V'_j = n / (n - 1) sum over units d_uj^2, which has all
//         of it where no two units share a member. What is right for this parameter, of few degrees of
//         freedom nu_j where few units tell it: one less than the units, the members or the effective units 1
//         / sum h_u^2, h_u = (A^-1 A_u)_jj, whichever are fewest;
//   W_j = phi c (A^-1)_jj, phi = sum e_u' A^-1 e_u / (k - S), e_u = s_u - A_u theta, S = sum tr (A^-1 A_u)^2:
//         the dispersion of all parameters together, each direction weighted as theta weighs it (where scores
//         have the variance phi A_u the expectation of the sum is phi (k - S)), and c >= 1 the mean over the
//         parameters of V_j / V'_j.
//
// One has little to go by, the other takes all parameters alike: as for variances of many genes (Smyth 2004)
// the moderated one is (nu_0 W_j + nu_j V_j) / (nu_0 + nu_j), with Student's law of nu_0 + nu_j degrees of
// freedom; nu_0 = 10, or the units less one where these are fewer. p: theta' A theta / (k phi c) against
// Fisher's F of k and (k - S) k / S degrees of freedom (Satterthwaite's number for phi).
PooledScores PoolScores(std::span<const UnitScore> units, double confidence);

// Parameter j alone, the others taken to be zero.
PooledParameter PoolScoreAlone(std::span<const UnitScore> units, Eigen::Index j, double confidence);

}  // namespace rcme
