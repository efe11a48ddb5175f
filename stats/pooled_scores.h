// Estimates a few parameters shared by all units (image pairs) of a set; each unit alone says little about
// them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

// One unit: its own least-squares estimate would be A^-1 s. Members as in shared_members.h: units with a
// common member are dependent; equal members mean that the unit has a single member.
struct UnitScore {
  std::int64_t member1 = 0, member2 = 0;
  Eigen::VectorXd score;        // s, k x 1
  Eigen::MatrixXd information;  // A, k x k, positive semidefinite
};

struct PooledParameter {
  double value = 0.0;           // NaN: the units do not determine it
  double standard_error = 0.0;  // NaN without an interval
  Interval interval;            // unbounded if at most one unit or member determines the parameter
  double effective_n = 0.0;     // number of units of equal weight with the same information
};

struct PooledScores {
  std::vector<PooledParameter> parameters;  // k; none without units
  double dispersion = 0.0;       // variance of the units over that implied by their A; NaN for one unit
  double p_value = 1.0;          // F-test of all parameters being zero; NaN if impossible
  Eigen::MatrixXd correlations;  // of the estimates, from the information; empty if singular
};

// theta = A^-1 sum s_u, A = sum A_u. Its accuracy is taken from the scatter of the units, since errors
// correlated within a unit make its own A too large. There are two estimates of the variance of theta_j:
//
//   V_j   a jackknife (CR3, Bell and McCaffrey 2002) over members: m / (m - 1) (sum over members d_ij^2 - sum
//         over units of two members d_uj^2). d_i = (A - A_i)^-1 sum (s_u - A_u theta) over the units of
//         member i, A_i their information; d_u is the same for one unit; all d are about their means. It is
//         the sum over pairs (u, v) that share a member of d_uj d_vj (shared_members.h), except that leaving
//         out a member removes all its units at once. At least V'_j = n / (n - 1) sum over units d_uj^2,
//         which is the whole variance if no two units share a member. V_j is specific to this parameter, but
//         has few degrees of freedom nu_j if few units determine it: one less than the number of units, of
//         members or of effective units 1 / sum h_u^2, h_u = (A^-1 A_u)_jj, whichever is smallest;
//   W_j = phi c (A^-1)_jj, phi = sum e_u' A^-1 e_u / (k - S), e_u = s_u - A_u theta, S = sum tr (A^-1 A_u)^2:
//         the common dispersion of all parameters, each direction weighted as theta weighs it (if scores have
//         the variance phi A_u, the expectation of the sum is phi (k - S)); c >= 1 is the mean over the
//         parameters of V_j / V'_j.
//
// V_j is noisy, W_j assumes that all parameters are alike. As for the variances of many genes (Smyth 2004)
// the moderated estimate is (nu_0 W_j + nu_j V_j) / (nu_0 + nu_j), with Student's law of nu_0 + nu_j degrees
// of freedom; nu_0 = 10, or the number of units minus one if that is smaller. p-value: theta' A theta / (k
// phi c) against Fisher's F with k and (k - S) k / S degrees of freedom (Satterthwaite's number for phi).
PooledScores PoolScores(std::span<const UnitScore> units, double confidence);

// Parameter j alone, with the others fixed at zero.
PooledParameter PoolScoreAlone(std::span<const UnitScore> units, Eigen::Index j, double confidence);

}  // namespace rcme
