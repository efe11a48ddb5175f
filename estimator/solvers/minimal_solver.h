// The interface of a minimal solver, the paper's Omega^-1 (Sec. model_instantiate), as a type. Five parts of
// the estimator use it: the draw of the sample, the models and their covariance (hypothesis.h), the sample
// test (sample_consistency.h), the loop, and the option `solver` (solver_list.h). For a worked example see
// one_point.h.
//
//   struct Solver {
//     static constexpr int kSampleSize;           // m, matches of a sample
//     static constexpr int kMaxModels;            // greatest number of models of a sample
//     static constexpr SolverCase kCase;          // the paper's two cases, below
//     static constexpr int kSampleTestDof;        // degrees of freedom of the sample test
//     using Rays = std::array<Eigen::Vector3d, kSampleSize>;  // K^-1 [x; 1], third component 1
//     using Model = ...;                          // with f and G as in MinimalModel
//     static ModelList<Model, kMaxModels> FindModels(const Rays& rays1, const Rays& rays2);
//   };
//
// FindModels allocates nothing. It returns no model if the sample is degenerate or not finite.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <array>
#include <cmath>
#include <optional>

#include "estimator/geometry/essential_matrix.h"

namespace rcme {

// The two cases of Sec. model_instantiate.
enum class SolverCase {
  kExact,           // f has as many parameters as F has degrees of freedom in the solver's family of motions
  kOverdetermined,  // f has more
};

// A model f_j of m matches and its sensitivity to noise: if g_k = x2_k' F x1_k (rays) is disturbed by n_k, f
// moves by delta f = -G n to first order. |f| = 1, so f'G = 0; the sign of f is arbitrary.
template <int m>
struct MinimalModel {
  Vector9d f = Vector9d::Zero();
  Eigen::Matrix<double, 9, m> G = Eigen::Matrix<double, 9, m>::Zero();
};

// At most `capacity` models, in the solver's order.
template <typename Model, int capacity>
struct ModelList {
  std::array<Model, capacity> models;
  int count = 0;

  void Add(const Model& model) { models[static_cast<size_t>(count++)] = model; }
  const Model* begin() const { return models.data(); }
  const Model* end() const { return models.data() + count; }
};

// The constraints of a sample as rows kron(x2, x1), so that row_k f = x2_k' F x1_k.
template <size_t m>
Eigen::Matrix<double, static_cast<int>(m), 9> ConstraintRows(const std::array<Eigen::Vector3d, m>& rays1,
                                                             const std::array<Eigen::Vector3d, m>& rays2) {
  Eigen::Matrix<double, static_cast<int>(m), 9> rows;
  for (size_t k = 0; k < m; ++k) {
    rows.row(static_cast<int>(k)) = Vectorize(rays2[k] * rays1[k].transpose());
  }
  return rows;
}

// G of a model that m equations C f = 0 determine on an m-dimensional manifold, by implicit differentiation.
// Along the manifold delta f = T y, T (9 x m) its tangent at f; C (f + T y) + n = 0 gives y = -(C T)^-1 n and
// G = T (C T)^-1. In the coordinates y this is the exact case (eq. 5): Sigma_y = (C T)^-1 D (C T)^-T. nullopt
// if C T is singular (smallest pivot below 1e-9 of the largest): the solution is not isolated.
template <int m>
std::optional<Eigen::Matrix<double, 9, m>> ImplicitGain(const Eigen::Matrix<double, m, 9>& C,
                                                        const Eigen::Matrix<double, 9, m>& T) {
  const Eigen::Matrix<double, m, m> H = C * T;
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, m, m>> qr(H);
  const auto pivot = [&](int k) { return std::abs(qr.matrixQR()(k, k)); };
  if (!(pivot(m - 1) > 1e-9 * pivot(0))) return std::nullopt;
  return Eigen::Matrix<double, 9, m>(T * qr.inverse());
}

}  // namespace rcme
