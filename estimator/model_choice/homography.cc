#include "estimator/model_choice/homography.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/geometry/essential_matrix.h"
#include "stats/constants.h"

namespace rcme {
namespace {

constexpr int kMaxRefits = 10, kMaxSteps = 10;
constexpr double kNegligibleDecrease = 1e-6;  // of the sum of d2
constexpr double kLeastArea = 1e-12;          // determinant of three rays: twice their triangle's area

// The first three rays as columns, scaled so that they sum to the fourth. nullopt if three of the four lie on
// one line.
std::optional<Eigen::Matrix3d> ProjectiveBasis(const FourMatches& sample, Eigen::Vector3d RayMatch::*ray) {
  Eigen::Matrix3d rays;
  rays << sample[0].*ray, sample[1].*ray, sample[2].*ray;
  const double area = rays.determinant();
  const Eigen::Vector3d weights = rays.inverse() * sample[3].*ray;
  // By Cramer's rule a weight is the area of a triangle with the fourth point over the first triangle's.
  if (!(std::abs(area) * std::min(1.0, weights.cwiseAbs().minCoeff()) > kLeastArea)) return std::nullopt;
  return Eigen::Matrix3d(rays * weights.asDiagonal());
}

// The normal equations of sum d2 / 2 over matches with C held fixed, as in RotationEquations.
struct HomographyEquations {
  Vector9d gradient = Vector9d::Zero();
  Matrix9d hessian = Matrix9d::Zero();
};

HomographyEquations Linearize(const RayMatches& all, const std::vector<size_t>& fitted,
                              const Eigen::Matrix3d& H) {
  HomographyEquations equations;
  for (const size_t i : fitted) {
    const std::optional<Transfer> transfer = EvaluateTransfer(H, all.matches[i], all.noise);
    if (!transfer) continue;
    const Eigen::RowVector3d over_depth = all.matches[i].ray1.transpose() / transfer->depth;
    Eigen::Matrix<double, 2, 9> dh;  // with respect to H, row by row
    dh << over_depth, Eigen::RowVector3d::Zero(), -transfer->h.x() * over_depth,  //
        Eigen::RowVector3d::Zero(), over_depth, -transfer->h.y() * over_depth;
    const Eigen::Matrix<double, 9, 2> weighted = dh.transpose() * transfer->information;
    equations.gradient -= weighted * transfer->e;
    equations.hessian += weighted * dh;
  }
  return equations;
}

// Least squares over the matches `fitted`. The scale of H is free: H itself spans the null space of the
// Hessian, and a multiple of H H' makes it regular without changing the step.
Eigen::Matrix3d Minimize(const RayMatches& all, const std::vector<size_t>& fitted,
                         const Eigen::Matrix3d& start) {
  Eigen::Matrix3d H = start;
  for (int i = 0; i < kMaxSteps; ++i) {
    const HomographyEquations at = Linearize(all, fitted, H);
    const Vector9d h = Vectorize(H) / H.norm();
    const Matrix9d regular = at.hessian + at.hessian.trace() / 9.0 * h * h.transpose();
    const Vector9d step = -regular.ldlt().solve(at.gradient);
    if (!step.allFinite()) return H;
    H += Matricize(step);
    H /= H.norm();
    if (-step.dot(at.gradient) < kNegligibleDecrease) return H;
  }
  return H;
}

std::vector<size_t> FindWithin(const RayMatches& all, const Eigen::Matrix3d& H, double threshold) {
  std::vector<size_t> within;
  for (size_t i = 0; i < all.matches.size(); ++i) {
    const std::optional<Transfer> transfer = EvaluateTransfer(H, all.matches[i], all.noise);
    if (transfer && transfer->d2 <= threshold) within.push_back(i);
  }
  return within;
}

}  // namespace

RayMatches::RayMatches(const MotionProblem& problem) : noise(MatchWhitening(problem).ray_scale()) {
  matches.reserve(problem.matches.size());
  for (const Correspondence& match : problem.matches) {
    matches.push_back({problem.camera1.Ray(match.x1_px), problem.camera2.Ray(match.x2_px)});
  }
}

std::optional<Eigen::Matrix3d> HomographyOfFour(const FourMatches& sample) {
  const std::optional<Eigen::Matrix3d> A = ProjectiveBasis(sample, &RayMatch::ray1);
  if (!A) return std::nullopt;
  const std::optional<Eigen::Matrix3d> B = ProjectiveBasis(sample, &RayMatch::ray2);
  if (!B) return std::nullopt;
  // H ray1 = depth ray2: the depths are the ratios of the scales of the two images, and 1 for the fourth.
  if (!((B->row(2).array() / A->row(2).array()) > 0.0).all()) return std::nullopt;
  const Eigen::Matrix3d H = *B * A->inverse();
  if (!H.allFinite()) return std::nullopt;
  return Eigen::Matrix3d(H / H.norm());
}

std::optional<Eigen::Matrix3d> RotationOfTwo(const TwoMatches& sample) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const RayMatch& match : sample)
    moments += match.ray2.normalized() * match.ray1.normalized().transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (!(svd.singularValues()(1) > kLeastArea)) return std::nullopt;
  const double sign = svd.matrixU().determinant() * svd.matrixV().determinant();
  return Eigen::Matrix3d(svd.matrixU() * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() *
                         svd.matrixV().transpose());
}

std::optional<Transfer> EvaluateTransfer(const Eigen::Matrix3d& H, const RayMatch& match,
                                         const RayScale& noise) {
  const Eigen::Vector3d y = H * match.ray1;
  if (!(y.z() > 0.0)) return std::nullopt;
  Transfer transfer{.e = {}, .h = y.head<2>() / y.z(), .depth = y.z(), .information = {}, .d2 = 0.0};
  transfer.e = match.ray2.head<2>() - transfer.h;
  const Eigen::Matrix2d J = (H.topLeftCorner<2, 2>() - transfer.h * H.row(2).head<2>()) / y.z();
  const Eigen::Matrix2d scaled = J * Eigen::Vector2d(noise.x1, noise.y1).asDiagonal();
  Eigen::Matrix2d C = scaled * scaled.transpose();
  C(0, 0) += noise.x2 * noise.x2;
  C(1, 1) += noise.y2 * noise.y2;
  transfer.information = C.inverse();
  transfer.d2 = transfer.e.dot(transfer.information * transfer.e);
  if (!(transfer.d2 >= 0.0)) return std::nullopt;  // NaN by overflow
  return transfer;
}

std::vector<double> SquaredTransfers(const RayMatches& all, const Eigen::Matrix3d& H) {
  std::vector<double> squared;
  squared.reserve(all.matches.size());
  for (const RayMatch& match : all.matches) {
    const std::optional<Transfer> transfer = EvaluateTransfer(H, match, all.noise);
    squared.push_back(transfer ? transfer->d2 : std::numeric_limits<double>::infinity());
  }
  return squared;
}

double TruncatedCost(const RayMatches& all, const Eigen::Matrix3d& H, double threshold, double enough) {
  double cost = 0.0;
  for (const RayMatch& match : all.matches) {
    const std::optional<Transfer> transfer = EvaluateTransfer(H, match, all.noise);
    cost += transfer ? std::min(transfer->d2, threshold) : threshold;
    if (cost > enough) break;
  }
  return cost;
}

Eigen::Matrix3d RefineHomography(const RayMatches& all, const Eigen::Matrix3d& start, double threshold) {
  Eigen::Matrix3d H = start;
  std::vector<size_t> fitted;
  for (int refit = 0; refit < kMaxRefits; ++refit) {
    std::vector<size_t> within = FindWithin(all, H, threshold);
    if (within.size() < 4 || within == fitted) break;
    fitted = std::move(within);
    H = Minimize(all, fitted, H);
  }
  const double cost = TruncatedCost(all, start, threshold, kInfinity);
  return TruncatedCost(all, H, threshold, cost) <= cost ? H : start;
}

}  // namespace rcme
