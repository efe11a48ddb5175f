#pragma once

#include "estimator/geometry/essential_matrix.h"
#include "estimator/motion_problem.h"
#include "estimator/ransac_options.h"
#include "estimator/refinement/fit_set.h"
#include "estimator/refinement/rotation_equations.h"

namespace rcme {

// Sets of matches as ascending indices, processed one by one; a model of MatchSets (refine_winner.h). Shares
// no code with the kernels.
class ReferenceMatches {
 public:
  using Set = std::vector<int>;
  ReferenceMatches(const MotionProblem& problem, RefinementError error) : problem_(problem), error_(error) {}

  const MotionProblem& problem() const { return problem_; }
  RelativePose SelectPose(const EssentialProjection& projection, const Set& set) const;
  RefinedMotion Refine(const Set& set, const RelativePose& start, Loss loss) const;
  Set FindAgreeing(const RefinedMotion& motion, const Set& fitted, double significance_level) const;
  Set SelectFitSet(const RefinedMotion& motion, const Set& fitted) const;
  Set FindConsistent(const RelativePose& pose, double threshold) const;
  int CountConsistent(const Set& set, const RelativePose& pose, double threshold) const;
  RotationEquations LinearizeRotation(const Set& set, const Eigen::Matrix3d& R, Loss loss) const;
  Set FindRotated(const Eigen::Matrix3d& R, double threshold) const;
  // The trivial bound, all matches: the reference always fits a rotation.
  int BoundRotated(double) const { return static_cast<int>(problem_.matches.size()); }
  double ChanceOfAgreement(const RelativePose& pose, double threshold) const;
  Eigen::Matrix2d SumDirectionNoise(const Set& set, const RelativePose& pose,
                                    const Eigen::Matrix2d& direction_cov) const;
  Set Intersect(const Set& a, const Set& b) const;
  Set MakeSet(const std::vector<int>& indices) const { return indices; }
  Set All() const;
  const std::vector<int>& ListIndices(const Set& set) const { return set; }
  int Count(const Set& set) const { return static_cast<int>(set.size()); }

 private:
  const MotionProblem& problem_;
  RefinementError error_;
};

}  // namespace rcme
