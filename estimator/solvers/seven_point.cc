#include "estimator/solvers/seven_point.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>
#include <numbers>

namespace rcme {
namespace {

// Gradient of det at F: det(F + dF) = det F + <cofactors, dF> + ...; the rows are cross products of F's.
Eigen::Matrix3d Cofactors(const Eigen::Matrix3d& F) {
  Eigen::Matrix3d cofactors;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d next = F.row((i + 1) % 3).transpose(), last = F.row((i + 2) % 3).transpose();
    cofactors.row(i) = next.cross(last).transpose();
  }
  return cofactors;
}

// Two matrices of norm 1, normal to each other; F = z A + B.
struct Pencil {
  Eigen::Matrix3d A, B;

  Pencil Turned(double angle) const {
    return {std::cos(angle) * A + std::sin(angle) * B, std::cos(angle) * B - std::sin(angle) * A};
  }
};

// The same pencil in one of four bases, chosen for the largest |det A|. det A is the leading coefficient of
// the cubic, so it must not vanish: no root may be infinite.
Pencil TurnAwayFromRoots(const Pencil& pencil) {
  Pencil best = pencil;
  for (int quarter = 1; quarter < 4; ++quarter) {
    const Pencil turned = pencil.Turned(quarter * std::numbers::pi / 4.0);
    if (std::abs(turned.A.determinant()) > std::abs(best.A.determinant())) best = turned;
  }
  return best;
}

// det(z A + B) / det A = z^3 + c(2) z^2 + c(1) z + c(0).
Eigen::Vector3d ComputeCubic(const Pencil& pencil) {
  const auto dot = [](const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) { return a.cwiseProduct(b).sum(); };
  return Eigen::Vector3d(pencil.B.determinant(), dot(Cofactors(pencil.B), pencil.A),
                         dot(Cofactors(pencil.A), pencil.B)) /
         pencil.A.determinant();
}

// f (unit) and G of a matrix of rank 2; nullopt if it is not an isolated solution.
std::optional<SevenPoint::Model> ModelFrom(const Eigen::Matrix3d& F, const Eigen::Matrix<double, 7, 9>& C) {
  SevenPoint::Model model;
  model.f = Vectorize(F).normalized();
  Eigen::Matrix<double, 9, 2> normal;
  normal << model.f, Vectorize(Cofactors(Matricize(model.f))).normalized();
  if (!normal.allFinite()) return std::nullopt;
  const Matrix9d Q = Eigen::HouseholderQR<Eigen::Matrix<double, 9, 2>>(normal).householderQ();
  const auto G = ImplicitGain<7>(C, Q.rightCols<7>());
  if (!G) return std::nullopt;
  model.G = *G;
  return model;
}

}  // namespace

// Every f of seven matches (eq::model_instantiate).
ModelList<SevenPoint::Model, SevenPoint::kMaxModels> SevenPoint::FindModels(const Rays& rays1,
                                                                            const Rays& rays2) {
  ModelList<Model, kMaxModels> models;
  const Eigen::Matrix<double, 7, 9> C = ConstraintRows(rays1, rays2);
  const Eigen::Matrix<double, 9, 7> C_transposed = C.transpose();
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 9, 7>> qr(C_transposed);
  const auto pivot = [&](int k) { return std::abs(qr.matrixQR()(k, k)); };
  if (!(pivot(6) > 1e-9 * pivot(0))) return models;
  const Matrix9d Q = qr.householderQ();
  const Pencil pencil = TurnAwayFromRoots({Matricize(Q.col(7)), Matricize(Q.col(8))});
  // A cubic that vanishes in four directions vanishes everywhere.
  if (!(std::abs(pencil.A.determinant()) > 1e-12)) return models;

  // The roots are the eigenvalues of the companion matrix.
  const Eigen::Vector3d cubic = ComputeCubic(pencil);
  Eigen::Matrix3d companion = Eigen::Matrix3d::Zero();
  companion(1, 0) = companion(2, 1) = 1.0;
  companion.col(2) = -cubic;
  const Eigen::EigenSolver<Eigen::Matrix3d> eigen(companion, false);
  if (eigen.info() != Eigen::Success) return models;
  for (int k = 0; k < 3; ++k) {
    if (eigen.eigenvalues()(k).imag() != 0.0) continue;
    const double z = eigen.eigenvalues()(k).real();
    if (const std::optional<Model> model = ModelFrom(z * pencil.A + pencil.B, C)) models.Add(*model);
  }
  return models;
}

}  // namespace rcme
