#include "experiments/real/truth_free/halves.h"

#include <numeric>

#include "estimator/noise_scale.h"
#include "experiments/data/data_source.h"
#include "experiments/trial/answer_check.h"
#include "stats/consistency.h"
#include "stats/median_ratio.h"

namespace rcme {
namespace {

constexpr size_t kLeastMatches = 20;

std::vector<bool> FirstHalf(const MotionProblem& problem, const MotionEstimate& whole, Split split,
                            const StreamName& name) {
  const size_t n = problem.matches.size();
  std::vector<bool> is_first(n);
  if (split == Split::kLeftRight || split == Split::kUpperLower) {
    const Eigen::Index axis = split == Split::kLeftRight ? 0 : 1;
    std::vector<double> places;
    for (const int i : whole.inliers) places.push_back(problem.matches[static_cast<size_t>(i)].x1_px(axis));
    const double border_px = ComputeMedian(std::move(places));
    for (size_t i = 0; i < n; ++i) is_first[i] = problem.matches[i].x1_px(axis) < border_px;
    return is_first;
  }
  RandomStream rng = StreamFor(name, StreamPurpose::kCheck);
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  rng.Shuffle(std::span(order));
  for (size_t k = 0; k < n / 2; ++k) is_first[order[k]] = true;
  return is_first;
}

}  // namespace

double NormalizedDifference(const MotionEstimate& a, const MotionEstimate& b) {
  const RelativePose &pose_a = a.cam2_from_cam1, &pose_b = b.cam2_from_cam1;
  Matrix5d to_a = Matrix5d::Identity();  // a direction's tangent at b, in the basis at a
  to_a.bottomRightCorner<2, 2>() = DirectionBasis(pose_a.t).transpose() * DirectionBasis(pose_b.t);
  const Matrix5d covariance =
      CovarianceWithoutErrors(a) + to_a * CovarianceWithoutErrors(b) * to_a.transpose();
  return NormalizedErrorSquared(LocalCoordinates(pose_a, pose_b), covariance);
}

std::optional<double> DifferenceOfHalves(const MotionProblem& problem, const MotionEstimate& whole,
                                         Split split, const MotionEstimator& estimator,
                                         const StreamName& name) {
  const std::vector<bool> is_first = FirstHalf(problem, whole, split, name);
  std::vector<MotionEstimate> answers;
  for (const bool first : {true, false}) {
    std::vector<size_t> members;
    for (size_t i = 0; i < is_first.size(); ++i) {
      if (is_first[i] == first) members.push_back(i);
    }
    const MotionProblem half = SelectPart(problem, members);
    if (half.matches.size() < kLeastMatches) return std::nullopt;
    RandomStream rng = StreamFor(name, first ? StreamPurpose::kSampling : StreamPurpose::kMonteCarlo);
    answers.push_back(Judged(estimator.Estimate(half, rng), half.matches.size()));
    if (answers.back().status != MotionStatus::kOk) return std::nullopt;
  }
  return NormalizedDifference(answers[0], answers[1]);
}

}  // namespace rcme
