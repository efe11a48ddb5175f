#include "experiments/real/truth_free/closure.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "estimator/robust_covariance/clustered_covariance.h"
#include "estimator/robust_covariance/disjoint_sets.h"

namespace rcme {
namespace {

using LoopCovariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
using LoopJacobian = Eigen::Matrix<double, Eigen::Dynamic, 5, 0, 3, 5>;

Eigen::Matrix3d ComputeStepRotation(const AnsweredStep& step) {
  const Eigen::Matrix3d& R = step.estimate->cam2_from_cam1.R;
  return step.is_forward ? R : Eigen::Matrix3d(R.transpose());
}

// The direction between the two centres, in the frame of the image where the step begins or ends.
Eigen::Vector3d DirectionIn(const AnsweredStep& step, bool at_begin) {
  const RelativePose& pose = step.estimate->cam2_from_cam1;
  const bool in_image1 = step.is_forward == at_begin;
  return in_image1 ? Eigen::Vector3d(pose.R.transpose() * pose.t) : pose.t;
}

// dc/dq of one step, by central differences.
LoopJacobian ComputeLoopJacobian(AnsweredLoop loop, size_t k, LoopErrorOf error_of) {
  constexpr double kStep = 1e-6;
  std::vector<AnsweredStep> moved(loop.begin(), loop.end());
  MotionEstimate estimate = *loop[k].estimate;
  moved[k].estimate = &estimate;
  const auto error_at = [&](Eigen::Index j, double by) {
    estimate.cam2_from_cam1 = Retract(loop[k].estimate->cam2_from_cam1, by * Vector5d::Unit(j));
    return error_of(moved);
  };
  LoopJacobian jacobian(error_of(loop).size(), 5);
  for (Eigen::Index j = 0; j < 5; ++j)
    jacobian.col(j) = (error_at(j, kStep) - error_at(j, -kStep)) / (2.0 * kStep);
  return jacobian;
}

// The moves of the closure error by the residuals of single matches, for all pairs of a loop, and which
// matches share key points.
class Moves {
 public:
  // `image1`, `image2`: numbers of the pair's images.
  void Add(const AnsweredStep& step, const LoopJacobian& jacobian, size_t image1, size_t image2) {
    const MotionProblem& problem = step.pair->problem;
    const std::vector<int>& inliers = step.estimate->inliers;
    const MatchScores scores = ScoreFitted(problem, inliers, step.estimate->cam2_from_cam1);
    const NamedPair& named = step.key_points ? *step.key_points : *step.pair;
    const Eigen::LDLT<Matrix5d> ldlt(scores.information);
    for (size_t k = 0; k < inliers.size(); ++k) {
      const Correspondence& match = named.problem.matches[static_cast<size_t>(inliers[k])];
      const Vector5d gain = ldlt.solve(scores.rows[k]);
      const double kept = std::max(1.0 - gain.dot(scores.rows[k]), 0.05);
      moves_.emplace_back(jacobian * gain * (scores.residuals[k] / kept));
      places_.push_back({image1, match.x1_px.x(), match.x1_px.y()});
      places_.push_back({image2, match.x2_px.x(), match.x2_px.y()});
    }
  }

  LoopCovariance OfSingleMatches() const { return SumOfProducts(moves_); }
  LoopCovariance OfSharedKeyPoints() const {
    DisjointSets sets(moves_.size());
    std::map<std::tuple<size_t, double, double>, size_t> first_at;
    for (size_t k = 0; k < places_.size(); ++k)
      sets.Unite(k / 2, first_at.try_emplace(places_[k], k / 2).first->second);
    std::vector<LoopError> sums(moves_.size(), LoopError::Zero(moves_.front().size()));
    for (size_t k = 0; k < moves_.size(); ++k) sums[sets.Find(k)] += moves_[k];
    return SumOfProducts(sums);
  }
  bool IsEmpty() const { return moves_.empty(); }

 private:
  static LoopCovariance SumOfProducts(const std::vector<LoopError>& moves) {
    LoopCovariance sum = LoopCovariance::Zero(moves.front().size(), moves.front().size());
    for (const LoopError& move : moves) sum += move * move.transpose();
    return sum;
  }

  std::vector<LoopError> moves_;
  std::vector<std::tuple<size_t, double, double>>
      places_;  // of both key points of each, with the number of the image
};

}  // namespace

LoopError RotationClosure(AnsweredLoop loop) {
  Eigen::Matrix3d around = Eigen::Matrix3d::Identity();
  for (const AnsweredStep& step : loop) around = ComputeStepRotation(step) * around;
  return VectorFromRotation(around);
}

LoopError DirectionClosure(AnsweredLoop triple) {
  const Eigen::Vector3d first = DirectionIn(triple[0], true),
                        second = ComputeStepRotation(triple[0]).transpose() * DirectionIn(triple[1], true),
                        last = DirectionIn(triple[2], false);
  return LoopError::Constant(1, first.dot(second.cross(last)));
}

std::optional<double> NormalizedClosure(AnsweredLoop loop, LoopErrorOf error_of, const LoopError& expected,
                                        SharedErrors shared) {
  LoopCovariance sigma = LoopCovariance::Zero(expected.size(), expected.size());
  Moves moves;
  for (size_t k = 0; k < loop.size(); ++k) {
    const LoopJacobian jacobian = ComputeLoopJacobian(loop, k, error_of);
    sigma += jacobian * CovarianceWithoutErrors(*loop[k].estimate) * jacobian.transpose();
    if (shared == SharedErrors::kIgnored) continue;
    const size_t next = (k + 1) % loop.size();
    moves.Add(loop[k], jacobian, loop[k].is_forward ? k : next, loop[k].is_forward ? next : k);
  }
  const Eigen::LLT<LoopCovariance> llt(sigma);
  if (llt.info() != Eigen::Success) return std::nullopt;
  const LoopError whitened = llt.matrixL().solve(LoopError(error_of(loop) - expected));
  if (shared == SharedErrors::kIgnored) return whitened.squaredNorm();
  if (moves.IsEmpty()) return std::nullopt;
  const Eigen::LLT<LoopCovariance> llt_single(moves.OfSingleMatches());
  if (llt_single.info() != Eigen::Success) return std::nullopt;
  const LoopCovariance half = llt_single.matrixL().solve(moves.OfSharedKeyPoints());
  const LoopCovariance half_turned = half.transpose();
  const LoopCovariance ratio = llt_single.matrixL().solve(half_turned);
  const Eigen::LLT<LoopCovariance> llt_ratio(ratio);
  if (llt_ratio.info() != Eigen::Success) return std::nullopt;
  return whitened.dot(llt_ratio.solve(whitened));
}

std::vector<UnitValues> ComputeClosures(const std::vector<PairAnswers>& answers,
                                        const std::vector<Loop>& loops, LoopErrorOf error_of,
                                        SharedErrors shared) {
  std::vector<UnitValues> closures;
  for (const Loop& loop : loops) {
    if (error_of == DirectionClosure && loop.size() != 3) continue;
    // The steps through the pairs, or through their twins of one number; empty if one has no motion.
    const auto steps_of = [&](const auto& choose) {
      std::vector<AnsweredStep> steps;
      for (const LoopStep& step : loop) {
        const Answered* answered = choose(answers[step.pair]);
        if (!answered || !answered->IsOk()) return std::vector<AnsweredStep>();
        steps.push_back(
            {&answered->pair, &answered->estimate, step.is_forward, &answers[step.pair].whole.pair});
      }
      return steps;
    };
    const std::vector<AnsweredStep> steps = steps_of([](const PairAnswers& pair) { return &pair.whole; });
    if (steps.empty()) continue;
    UnitValues values;
    const LoopError truth_of_twins = error_of(steps);
    const auto add = [&](const std::vector<AnsweredStep>& of, const LoopError& expected,
                         std::vector<double>* to) {
      if (of.empty()) return;
      const std::optional<double> closure = NormalizedClosure(of, error_of, expected, shared);
      if (closure) to->push_back(*closure);
    };
    add(steps, LoopError::Zero(truth_of_twins.size()), &values.observed);
    for (size_t k = 0; k < answers[loop.front().pair].twins.size(); ++k) {
      add(steps_of([k](const PairAnswers& pair) { return k < pair.twins.size() ? &pair.twins[k] : nullptr; }),
          truth_of_twins, &values.null);
    }
    closures.push_back(std::move(values));
  }
  return closures;
}

}  // namespace rcme
