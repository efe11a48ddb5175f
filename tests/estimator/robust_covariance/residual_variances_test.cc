// The moments' equations against the same written out with whole matrices, n x n.
#include "estimator/robust_covariance/residual_variances.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "stats/random.h"
#include "tests/test_support/linear_algebra.h"

namespace rcme {
namespace {

constexpr std::array<double, 3> kLengthsPx = {30.0, 90.0, 270.0};
constexpr int kNumMatches = 60;

struct DrawnResiduals {
  MatchScores scores;
  std::vector<int> groups;
};

// c_ij(l) of two matches, at the key points' first matches.
double ComputeCorrelation(const DrawnResiduals& sample, size_t first_i, size_t first_j, double length_px) {
  const Correspondence &a = sample.scores.matches[first_i], &b = sample.scores.matches[first_j];
  const Eigen::Vector4d &u = sample.scores.normals[first_i], &v = sample.scores.normals[first_j];
  return u.head<2>().dot(v.head<2>()) * std::exp(-(a.x1_px - b.x1_px).norm() / length_px) +
         u.tail<2>().dot(v.tail<2>()) * std::exp(-(a.x2_px - b.x2_px).norm() / length_px);
}

// The first match of each match's key point.
std::vector<size_t> FirstOfEach(const std::vector<int>& groups) {
  std::vector<size_t> first_of_group, firsts;
  for (size_t i = 0; i < groups.size(); ++i) {
    const auto g = static_cast<size_t>(groups[i]);
    if (g == first_of_group.size()) first_of_group.push_back(i);
    firsts.push_back(first_of_group[g]);
  }
  return firsts;
}

// K_b: what v_b stands before.
std::array<Eigen::MatrixXd, 5> ComputeKernels(const DrawnResiduals& sample) {
  const std::vector<size_t> first = FirstOfEach(sample.groups);
  const auto n = static_cast<Eigen::Index>(first.size());
  std::array<Eigen::MatrixXd, 5> K;
  K.fill(Eigen::MatrixXd::Zero(n, n));
  K[0].setIdentity();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const size_t a = first[static_cast<size_t>(i)], b = first[static_cast<size_t>(j)];
      K[1](i, j) = a == b;
      for (size_t k = 0; k < 3; ++k)
        K[2 + k](i, j) = a == b ? 1.0 : ComputeCorrelation(sample, a, b, kLengthsPx[k]);
    }
  }
  return K;
}

// W_a: the quadratic forms of the moments.
std::array<Eigen::MatrixXd, 5> ComputeWeights(const std::array<Eigen::MatrixXd, 5>& K) {
  const auto n = K[0].rows();
  const Eigen::VectorXd m = K[1].rowwise().sum();  // matches of each one's key point
  std::array<Eigen::MatrixXd, 5> W;
  W.fill(Eigen::MatrixXd::Zero(n, n));
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const bool is_same = K[1](i, j) == 1.0;
      if (i == j) W[0](i, j) = 1.0 / m(i);
      if (i != j && is_same) W[1](i, j) = 1.0 / (m(i) * (m(i) - 1.0));
      for (size_t k = 2; k < 5; ++k) W[k](i, j) = is_same ? 0.0 : K[k](i, j) / (m(i) * m(j));
    }
  }
  return W;
}

// As in the header, term by term: q = T v, M, of all subsets with v >= 0 the best, if by a deviance of 1.
ResidualVariances VariancesByHand(const DrawnResiduals& sample) {
  const auto n = static_cast<Eigen::Index>(sample.groups.size());
  Eigen::MatrixXd J(n, 5);
  Eigen::VectorXd r(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    J.row(i) = sample.scores.rows[static_cast<size_t>(i)].transpose();
    r(i) = sample.scores.residuals[static_cast<size_t>(i)];
  }
  const Matrix5d inverse = Inverse(sample.scores.information);
  const Eigen::MatrixXd P = Eigen::MatrixXd::Identity(n, n) - Propagate(J, inverse);
  const auto K = ComputeKernels(sample);
  const auto W = ComputeWeights(K);
  Eigen::VectorXd q(5);
  Eigen::MatrixXd T(5, 5), M(5, 5);
  for (int a = 0; a < 5; ++a) {
    const Eigen::MatrixXd& Wa = W[static_cast<size_t>(a)];
    q(a) = Propagate(r.transpose(), Wa)(0, 0);
    for (int b = 0; b < 5; ++b) {
      T(a, b) = Multiply(Wa, Propagate(P, K[static_cast<size_t>(b)])).trace();
      M(a, b) = Multiply(Wa, W[static_cast<size_t>(b)]).trace();
    }
  }
  std::vector<int> known;
  for (int a = 0; a < 5; ++a) {
    if (a == 0 || M(a, a) >= 1.0) known.push_back(a);
  }
  const Eigen::MatrixXd M_inverse = Inverse(M(known, known));
  const Eigen::VectorXd q_known = q(known);
  // The misfit (q - T v)' M^-1 (q - T v) of the parts of `chosen`, a bit for each.
  const auto fit = [&](unsigned chosen, Eigen::VectorXd* v) {
    std::vector<int> active;
    for (size_t k = 0; k < known.size(); ++k) {
      if ((chosen >> k & 1u) != 0) active.push_back(known[k]);
    }
    const Eigen::MatrixXd T_active = T(known, active);
    const Eigen::MatrixXd normal = Propagate(T_active.transpose(), M_inverse);
    const Eigen::MatrixXd right = Multiply(T_active.transpose(), Multiply(M_inverse, q_known));
    const Eigen::VectorXd solved = Multiply(Inverse(normal), right);
    v->setZero(5);
    (*v)(active) = solved;
    const Eigen::VectorXd left = q_known - Multiply(T_active, solved);
    return Propagate(left.transpose(), M_inverse)(0, 0);
  };
  Eigen::VectorXd best, v;
  const double alone = fit(1u, &best), variance = best(0);
  ResidualVariances variances;
  for (unsigned chosen = 3u; chosen < 1u << known.size(); chosen += 2u) {  // the own part is always there
    const double deviance = (alone - fit(chosen, &v)) / (2.0 * variance * variance);
    if (!(v.minCoeff() >= 0.0) || !(deviance > std::max(variances.deviance, 1.0))) continue;
    variances.deviance = deviance;
    best = v;
  }
  variances.own = best(0);
  variances.of_key_point = best(1);
  Matrix5d middle = Matrix5d::Zero();
  for (int b = 1; b < 5; ++b) {
    if (b > 1) variances.of_neighbours.push_back(best(b));
    middle += best(b) * Propagate(J.transpose(), K[static_cast<size_t>(b)]);
  }
  variances.shared = Propagate(inverse, middle);
  return variances;
}

// Errors of the law of the header, fitted; `is_repeated`: every third match is of the key point before it, or
// beyond these of one key point of four.
DrawnResiduals DrawSample(bool is_repeated, double own, double of_key_point, double of_neighbours,
                          std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 73});
  DrawnResiduals sample;
  for (int i = 0; i < kNumMatches; ++i) {
    const bool is_of_last = is_repeated && (i % 3 == 2 || (i > 40 && i < 44));
    sample.groups.push_back(i == 0 ? 0 : sample.groups.back() + (is_of_last ? 0 : 1));
    sample.scores.matches.push_back(
        {{300.0 * rng.Uniform(), 200.0 * rng.Uniform()}, {300.0 * rng.Uniform(), 200.0 * rng.Uniform()}});
    const Eigen::Vector4d normal(rng.Normal(), rng.Normal(), rng.Normal(), rng.Normal());
    sample.scores.normals.emplace_back(normal.normalized());
    Vector5d row;
    for (double& x : row) x = 1.0 + rng.Normal();
    sample.scores.rows.push_back(row);
    sample.scores.information += row * row.transpose();
  }
  const auto K = ComputeKernels(sample);
  const Eigen::MatrixXd V = own * K[0] + of_key_point * K[1] + of_neighbours * K[3];
  Eigen::VectorXd z(kNumMatches);
  for (double& x : z) x = rng.Normal();
  const Eigen::VectorXd errors = Multiply(CholeskyFactor(V), z);
  Vector5d moment = Vector5d::Zero();
  for (size_t i = 0; i < kNumMatches; ++i)
    moment += errors(static_cast<Eigen::Index>(i)) * sample.scores.rows[i];
  const Vector5d solved = Multiply(Inverse(sample.scores.information), moment);
  for (size_t i = 0; i < kNumMatches; ++i)
    sample.scores.residuals.push_back(errors(static_cast<Eigen::Index>(i)) -
                                      sample.scores.rows[i].dot(solved));
  return sample;
}

// A part dropped, counted twice or halved, a wrong length, normal or projection would show in any draw.
TEST(ResidualVariances, AreThoseOfTheEquationsWrittenOut) {
  int num_shared = 0, num_alone = 0, num_of_key_points = 0, num_of_neighbours = 0;
  for (const bool is_repeated : {true, false}) {
    for (const auto& [own, of_key_point, of_neighbours] :
         {std::array{1.0, 0.0, 0.0}, std::array{0.4, 0.6, 0.0}, std::array{0.3, 0.2, 0.8}}) {
      for (std::uint32_t trial = 0; trial < 10; ++trial) {
        const DrawnResiduals sample = DrawSample(is_repeated, own, of_key_point, of_neighbours, trial);
        const ResidualVariances found = FitResidualVariances(sample.scores, sample.groups);
        const ResidualVariances expected = VariancesByHand(sample);
        ASSERT_NEAR(found.own, expected.own, 1e-10) << trial;
        ASSERT_NEAR(found.of_key_point, expected.of_key_point, 1e-10) << trial;
        ASSERT_EQ(found.of_neighbours.size(), 3u);
        for (size_t k = 0; k < 3; ++k) ASSERT_NEAR(found.of_neighbours[k], expected.of_neighbours[k], 1e-10);
        ASSERT_NEAR(found.deviance, expected.deviance, 1e-8 * (1.0 + expected.deviance)) << trial;
        ASSERT_LE((found.shared - expected.shared).norm(), 1e-10 * expected.shared.norm()) << trial;
        (expected.deviance > 0.0 ? num_shared : num_alone) += 1;
        num_of_key_points += expected.of_key_point > 0.0;
        num_of_neighbours +=
            expected.of_neighbours[0] + expected.of_neighbours[1] + expected.of_neighbours[2] > 0.0;
      }
    }
  }
  // Every kind was there.
  EXPECT_GE(num_shared, 10);
  EXPECT_GE(num_alone, 10);
  EXPECT_GE(num_of_key_points, 5);
  EXPECT_GE(num_of_neighbours, 5);
}

TEST(ResidualVariances, AddUp) {
  ResidualVariances variances;
  variances.own = 0.5;
  variances.of_key_point = 0.25;
  variances.of_neighbours = {0.125, 1.0, 2.0};
  EXPECT_EQ(variances.Sum(), 3.875);
}

TEST(ResidualVariances, WithoutMatchesOrInformationAllIsOwn) {
  EXPECT_EQ(FitResidualVariances({}, {}).own, 1.0);
  DrawnResiduals sample = DrawSample(false, 1.0, 0.0, 0.0, 0);
  sample.scores.information(1, 1) = -1.0;
  const ResidualVariances variances = FitResidualVariances(sample.scores, sample.groups);
  EXPECT_EQ(variances.own, 1.0);
  EXPECT_EQ(variances.shared.norm(), 0.0);
}

// Known variances at a length of their own: A^-1 J' (v_1 K_1 + v_l K_l) J A^-1 with whole matrices.
TEST(TakeResidualVariances, IsTheSandwichWrittenOut) {
  for (const double length_px : {50.0, 270.0, 700.0}) {
    const DrawnResiduals sample = DrawSample(true, 1.0, 0.0, 0.0, 5);
    const std::vector<size_t> first = FirstOfEach(sample.groups);
    Eigen::MatrixXd J(kNumMatches, 5), K(kNumMatches, kNumMatches);
    for (Eigen::Index i = 0; i < kNumMatches; ++i) {
      J.row(i) = sample.scores.rows[static_cast<size_t>(i)].transpose();
      for (Eigen::Index j = 0; j < kNumMatches; ++j) {
        const size_t a = first[static_cast<size_t>(i)], b = first[static_cast<size_t>(j)];
        K(i, j) = 0.3 * (a == b) + 0.2 * (a == b ? 1.0 : ComputeCorrelation(sample, a, b, length_px));
      }
    }
    const Matrix5d expected = Propagate(Inverse(sample.scores.information), Propagate(J.transpose(), K));
    const ResidualVariances taken =
        TakeResidualVariances(sample.scores, sample.groups, {0.5, 0.3, 0.2, length_px});
    EXPECT_LT((taken.shared - expected).norm(), 1e-10 * expected.norm()) << length_px;
    EXPECT_NEAR(taken.Sum(), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace rcme
