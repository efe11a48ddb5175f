#include "experiments/truth_free/closure.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <map>
#include <utility>

#include "estimator/robust_covariance/clustered_covariance.h"

namespace rcme {
namespace {

using Place = std::pair<double, double>;  // of a key point, px

// The move of a pair's part of the closure that the residual of each inlier makes.
struct Moves {
  std::vector<Eigen::Vector3d> of_match;
  std::vector<Place> place1, place2;
};

Moves MovesOf(const AnsweredPair& answered, const Eigen::Matrix3d& to_closure) {
  const MotionProblem& problem = answered.pair->problem;
  const std::vector<int>& inliers = answered.estimate->inliers;
  const MatchScores scores = ScoreFitted(problem, inliers, answered.estimate->cam2_from_cam1);
  const Eigen::LDLT<Matrix5d> ldlt(scores.information);
  Moves moves;
  for (size_t k = 0; k < inliers.size(); ++k) {
    const Correspondence& match = problem.matches[static_cast<size_t>(inliers[k])];
    const Vector5d gain = ldlt.solve(scores.rows[k]);
    const double kept = std::max(1.0 - gain.dot(scores.rows[k]), 0.05);
    moves.of_match.emplace_back(to_closure * gain.head<3>() * (scores.residuals[k] / kept));
    moves.place1.emplace_back(match.x1_px.x(), match.x1_px.y());
    moves.place2.emplace_back(match.x2_px.x(), match.x2_px.y());
  }
  return moves;
}

// Sum over the matches of two pairs that share a key point of the products of their moves, both ways round.
Eigen::Matrix3d InCommon(const Moves& a, const std::vector<Place>& places_a, const Moves& b,
                         const std::vector<Place>& places_b) {
  std::multimap<Place, size_t> at;
  for (size_t k = 0; k < places_a.size(); ++k) at.emplace(places_a[k], k);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (size_t k = 0; k < places_b.size(); ++k) {
    const auto [first, last] = at.equal_range(places_b[k]);
    for (auto it = first; it != last; ++it) sum += a.of_match[it->second] * b.of_match[k].transpose();
  }
  return sum + sum.transpose();
}

}  // namespace

std::vector<Triple> FindTriples(const std::vector<NamedPair>& pairs) {
  std::map<std::pair<std::string, std::string>, size_t> number_of;
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (!pairs[i].image1.empty() && !pairs[i].image2.empty())
      number_of.try_emplace({pairs[i].image1, pairs[i].image2}, i);
  }
  std::vector<Triple> triples;
  for (const auto& [first, ab] : number_of) {
    for (const auto& [second, bc] : number_of) {
      if (second.first != first.second) continue;
      const auto third = number_of.find({first.first, second.second});
      if (third != number_of.end()) triples.push_back({ab, bc, third->second});
    }
  }
  return triples;
}

Eigen::Vector3d ClosureOf(const MotionEstimate& ab, const MotionEstimate& bc, const MotionEstimate& ac) {
  return VectorFromRotation(ac.cam2_from_cam1.R.transpose() * bc.cam2_from_cam1.R * ab.cam2_from_cam1.R);
}

std::optional<double> NormalizedClosure(const AnsweredPair& ab, const AnsweredPair& bc,
                                        const AnsweredPair& ac, const Eigen::Vector3d& expected) {
  const Eigen::Matrix3d to_ab = ab.estimate->cam2_from_cam1.R.transpose(),
                        to_bc = ac.estimate->cam2_from_cam1.R.transpose(), to_ac = -to_bc;
  Eigen::Matrix3d sigma = Eigen::Matrix3d::Zero();
  for (const auto& [answered, M] : {std::pair{&ab, &to_ab}, {&bc, &to_bc}, {&ac, &to_ac}})
    sigma += *M * answered->estimate->pose_cov.topLeftCorner<3, 3>() * M->transpose();
  const Moves of_ab = MovesOf(ab, to_ab), of_bc = MovesOf(bc, to_bc), of_ac = MovesOf(ac, to_ac);
  sigma += InCommon(of_ab, of_ab.place2, of_bc, of_bc.place1);
  sigma += InCommon(of_ab, of_ab.place1, of_ac, of_ac.place1);
  sigma += InCommon(of_bc, of_bc.place2, of_ac, of_ac.place2);
  const Eigen::LLT<Eigen::Matrix3d> llt(sigma);
  if (llt.info() != Eigen::Success) return std::nullopt;
  const Eigen::Vector3d c = ClosureOf(*ab.estimate, *bc.estimate, *ac.estimate) - expected;
  return c.dot(llt.solve(c));
}

}  // namespace rcme
