#include "experiments/truth_free/closure.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "estimator/robust_covariance/clustered_covariance.h"
#include "estimator/robust_covariance/disjoint_sets.h"

namespace rcme {
namespace {

// The moves of the closure that the residuals of single matches make, 3x1 each, of three pairs in one row;
// and which matches share key points.
class Moves {
 public:
  // `image1`, `image2`: numbers of the pair's images.
  void Add(const AnsweredPair& answered, const Eigen::Matrix3d& to_closure, int image1, int image2) {
    const MotionProblem& problem = answered.pair->problem;
    const std::vector<int>& inliers = answered.estimate->inliers;
    const MatchScores scores = ScoreFitted(problem, inliers, answered.estimate->cam2_from_cam1);
    const Eigen::LDLT<Matrix5d> ldlt(scores.information);
    for (size_t k = 0; k < inliers.size(); ++k) {
      const Correspondence& match = problem.matches[static_cast<size_t>(inliers[k])];
      const Vector5d gain = ldlt.solve(scores.rows[k]);
      const double kept = std::max(1.0 - gain.dot(scores.rows[k]), 0.05);
      moves_.emplace_back(to_closure * gain.head<3>() * (scores.residuals[k] / kept));
      places_.push_back({image1, match.x1_px.x(), match.x1_px.y()});
      places_.push_back({image2, match.x2_px.x(), match.x2_px.y()});
    }
  }

  Eigen::Matrix3d OfSingleMatches() const {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& move : moves_) sum += move * move.transpose();
    return sum;
  }
  Eigen::Matrix3d OfSharedKeyPoints() const {
    DisjointSets sets(moves_.size());
    std::map<std::tuple<int, double, double>, size_t> first_at;
    for (size_t k = 0; k < places_.size(); ++k)
      sets.Unite(k / 2, first_at.try_emplace(places_[k], k / 2).first->second);
    std::vector<Eigen::Vector3d> sums(moves_.size(), Eigen::Vector3d::Zero());
    for (size_t k = 0; k < moves_.size(); ++k) sums[sets.Find(k)] += moves_[k];
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& move : sums) sum += move * move.transpose();
    return sum;
  }

 private:
  std::vector<Eigen::Vector3d> moves_;
  std::vector<std::tuple<int, double, double>>
      places_;  // of both key points of each, with the number of the image
};

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
  Moves moves;
  moves.Add(ab, to_ab, 0, 1);
  moves.Add(bc, to_bc, 1, 2);
  moves.Add(ac, to_ac, 0, 2);
  const Eigen::LLT<Eigen::Matrix3d> llt(sigma), llt_single(moves.OfSingleMatches());
  if (llt.info() != Eigen::Success || llt_single.info() != Eigen::Success) return std::nullopt;
  const Eigen::Matrix3d shared = moves.OfSharedKeyPoints();
  const Eigen::Matrix3d half = llt_single.matrixL().solve(shared);
  const Eigen::Matrix3d ratio = llt_single.matrixL().solve(half.transpose());
  const Eigen::Vector3d c = ClosureOf(*ab.estimate, *bc.estimate, *ac.estimate) - expected;
  const Eigen::LLT<Eigen::Matrix3d> llt_ratio(ratio);
  if (llt_ratio.info() != Eigen::Success) return std::nullopt;
  const Eigen::Vector3d whitened = llt.matrixL().solve(c);
  return whitened.dot(llt_ratio.solve(whitened));
}

}  // namespace rcme
