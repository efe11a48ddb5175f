#include "estimator/robust_covariance/clustered_covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "estimator/geometry/sampson.h"
#include "estimator/noise_scale.h"
#include "estimator/refinement/sampson_equations.h"
#include "estimator/robust_covariance/disjoint_sets.h"

namespace rcme {
namespace {

// So many points of a cell stand for all in it: more would take quadratic time.
constexpr size_t kMostOfCell = 16;
constexpr double kLeastKept = 0.05;  // of the information along a direction, without a group

// Unites the matches whose points in one image are within the radius: each looks at the points before it in
// its own and the eight cells around it, of a grid as wide as the radius.
void UniteNeighbours(const std::vector<Correspondence>& matches, Eigen::Vector2d Correspondence::*x_px,
                     double radius_px, DisjointSets* groups) {
  std::map<std::pair<double, double>, std::vector<size_t>> cells;
  for (size_t i = 0; i < matches.size(); ++i) {
    const Eigen::Vector2d& x = matches[i].*x_px;
    const Eigen::Vector2d cell = (x / radius_px).array().floor();
    for (const double dx : {-1.0, 0.0, 1.0}) {
      for (const double dy : {-1.0, 0.0, 1.0}) {
        const auto found = cells.find({cell.x() + dx, cell.y() + dy});
        if (found == cells.end()) continue;
        for (const size_t k : found->second) {
          if ((matches[k].*x_px - x).norm() <= radius_px) groups->Unite(i, k);
        }
      }
    }
    std::vector<size_t>& own = cells[{cell.x(), cell.y()}];
    if (own.size() < kMostOfCell) own.push_back(i);
  }
}

}  // namespace

MatchScores ScoreFitted(const MotionProblem& problem, std::span<const int> fitted, const RelativePose& pose) {
  const SampsonLinearization model(problem, pose);
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(pose), problem.camera1, problem.camera2);
  MatchScores scores;
  for (const int index : fitted) {
    const auto i = static_cast<size_t>(index);
    const Correspondence& match = problem.matches[i];
    const SampsonResidual residual = model.Evaluate(match, NoiseScaleAt(problem, i));
    scores.matches.push_back(match);
    scores.normals.push_back(EvaluateConstraint(F, match).gradient.normalized());
    const Vector5d row = residual.g_p / residual.norm;
    scores.rows.push_back(row);
    scores.residuals.push_back(residual.r);
    scores.information += row * row.transpose();
  }
  return scores;
}

Matrix5d ClusteredCovariance(const MatchScores& scores, std::span<const int> groups) {
  const Eigen::LLT<Matrix5d> llt(scores.information);
  if (llt.info() != Eigen::Success) return Matrix5d::Constant(std::numeric_limits<double>::quiet_NaN());
  // In coordinates in which A is the identity.
  const Matrix5d L = llt.matrixL();
  struct Sums {
    int num_matches = 0;
    Vector5d score = Vector5d::Zero();
    Matrix5d information = Matrix5d::Zero();
  };
  const int num_groups = groups.empty() ? 0 : *std::ranges::max_element(groups) + 1;
  std::vector<Sums> sums(static_cast<size_t>(num_groups));
  for (size_t i = 0; i < groups.size(); ++i) {
    const Vector5d row = L.triangularView<Eigen::Lower>().solve(scores.rows[i]);
    Sums& of_group = sums[static_cast<size_t>(groups[i])];
    ++of_group.num_matches;
    of_group.score += scores.residuals[i] * row;
    of_group.information += row * row.transpose();
  }
  Matrix5d whitened = Matrix5d::Zero();
  for (const Sums& of_group : sums) {
    Vector5d moved;
    if (of_group.num_matches == 1) {
      moved = of_group.score / std::max(1.0 - of_group.information.trace(), kLeastKept);
    } else {
      const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(of_group.information);
      const Vector5d kept = (1.0 - eigen.eigenvalues().array()).max(kLeastKept);
      moved = eigen.eigenvectors() * (eigen.eigenvectors().transpose() * of_group.score).cwiseQuotient(kept);
    }
    whitened += moved * moved.transpose();
  }
  const Matrix5d half = L.transpose().triangularView<Eigen::Upper>().solve(whitened);
  const Matrix5d covariance = L.transpose().triangularView<Eigen::Upper>().solve(half.transpose());
  return 0.5 * (covariance + covariance.transpose());
}

std::vector<int> Separate(size_t num_matches) {
  std::vector<int> groups(num_matches);
  std::iota(groups.begin(), groups.end(), 0);
  return groups;
}

std::vector<int> KeyPointGroups(const std::vector<Correspondence>& matches, double radius_px) {
  DisjointSets groups(matches.size());
  UniteNeighbours(matches, &Correspondence::x1_px, radius_px, &groups);
  UniteNeighbours(matches, &Correspondence::x2_px, radius_px, &groups);
  return groups.Numbers();
}

std::vector<int> BlockGroups(const Camera& camera1, const std::vector<Correspondence>& matches,
                             int per_side) {
  std::map<std::pair<int, int>, int> number_of;
  std::vector<int> groups;
  const auto block = [&](double x_px, int length_px) {
    return static_cast<int>(std::clamp(std::floor((x_px + 0.5) / length_px * per_side), 0.0, per_side - 1.0));
  };
  for (const Correspondence& match : matches) {
    const std::pair<int, int> at = {block(match.x1_px.x(), camera1.width),
                                    block(match.x1_px.y(), camera1.height)};
    const int next = static_cast<int>(number_of.size());
    groups.push_back(number_of.try_emplace(at, next).first->second);
  }
  return groups;
}

}  // namespace rcme
