#pragma once

#include "estimator/geometry/essential_matrix.h"
#include "estimator/kernels/match_blocks.h"
#include "estimator/motion_problem.h"
#include "estimator/ransac_options.h"
#include "estimator/refinement/fit_set.h"

namespace rcme {

// Sets of matches as ascending indices, looked at one by one; see refine_winner.h.
class ReferenceMatches {
 public:
  using Set = std::vector<int>;
  ReferenceMatches(const MotionProblem& problem, RefinementError error)
      : problem_(problem), blocks_(problem), error_(error) {}

  const MotionProblem& problem() const { return problem_; }
  const MatchBlocks& blocks() const { return blocks_; }
  RelativePose SelectPose(const EssentialProjection& projection, const Set& set) const;
  RefinedMotion Refine(const Set& set, const RelativePose& start, Loss loss) const;
  Set FindAgreeing(const RefinedMotion& motion, const Set& fitted, double significance_level) const;
  Set SelectFitSet(const RefinedMotion& motion, const Set& fitted) const;
  int CountConsistent(const Set& set, const RelativePose& pose, double threshold) const;
  Set SetOf(const std::vector<int>& indices) const { return indices; }
  Set All() const;
  const std::vector<int>& IndicesOf(const Set& set) const { return set; }
  int Count(const Set& set) const { return static_cast<int>(set.size()); }

 private:
  const MotionProblem& problem_;
  MatchBlocks blocks_;
  RefinementError error_;
};

}  // namespace rcme
