#pragma once

#include "estimator/geometry/essential_matrix.h"
#include "estimator/kernels/match_blocks.h"
#include "estimator/kernels/score.h"
#include "estimator/ransac_options.h"
#include "estimator/refinement/rotation_equations.h"

namespace rcme {

// Sets of matches as bits, many matches at a time; see refine_winner.h. Makes the same decisions as
// ReferenceMatches, to rounding.
class BlockMatches {
 public:
  using Set = MatchMask;
  BlockMatches(const MotionProblem& problem, const MatchBlocks& matches, RefinementError error)
      : problem_(problem), matches_(matches), error_(error) {}

  const MotionProblem& problem() const { return problem_; }
  RelativePose SelectPose(const EssentialProjection& projection, const Set& set) const;
  RefinedMotion Refine(const Set& set, const RelativePose& start, Loss loss) const;
  Set FindAgreeing(const RefinedMotion& motion, const Set& fitted, double significance_level) const;
  Set SelectFitSet(const RefinedMotion& motion, const Set& fitted) const;
  Set FindConsistent(const RelativePose& pose, double threshold) const;
  int CountConsistent(const Set& set, const RelativePose& pose, double threshold) const;
  RotationEquations LinearizeRotation(const Set& set, const Eigen::Matrix3d& R, Loss loss) const;
  Set FindRotated(const Eigen::Matrix3d& R, double threshold) const;
  int BoundRotated(double threshold) const;
  double ChanceOfAgreement(const RelativePose& pose, double threshold) const;
  Eigen::Matrix2d SumDirectionNoise(const Set& set, const RelativePose& pose,
                                    const Eigen::Matrix2d& direction_cov) const;
  Set Intersect(const Set& a, const Set& b) const { return Intersection(a, b); }
  Set MakeSet(const std::vector<int>& indices) const { return MakeMask(indices, matches_); }
  Set All() const { return matches_.All(); }
  std::vector<int> ListIndices(const Set& set) const { return rcme::ListIndices(set); }
  int Count(const Set& set) const { return CountIn(set); }

 private:
  const MotionProblem& problem_;
  const MatchBlocks& matches_;
  RefinementError error_;
};

}  // namespace rcme
