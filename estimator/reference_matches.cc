#include "estimator/reference_matches.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "estimator/geometry/sampson.h"
#include "estimator/geometry/triangulation.h"
#include "estimator/motion_chance.h"
#include "estimator/observability.h"
#include "estimator/refinement/reprojection_mle.h"
#include "estimator/refinement/sampson_mle.h"

namespace rcme {

RelativePose ReferenceMatches::SelectPose(const EssentialProjection& projection, const Set& set) const {
  std::vector<Correspondence> matches;
  for (const int index : set) matches.push_back(problem_.matches[static_cast<size_t>(index)]);
  return SelectPoseByCheirality(PosesFromEssential(projection), matches, problem_.camera1, problem_.camera2);
}

RefinedMotion ReferenceMatches::Refine(const Set& set, const RelativePose& start, Loss loss) const {
  return error_ == RefinementError::kReprojection ? RefineByReprojection(problem_, set, start, loss)
                                                  : RefineBySampson(problem_, set, start, loss);
}

ReferenceMatches::Set ReferenceMatches::FindAgreeing(const RefinedMotion& motion, const Set& fitted,
                                                     double significance_level) const {
  return rcme::FindAgreeing(problem_, motion, fitted, significance_level);
}

ReferenceMatches::Set ReferenceMatches::SelectFitSet(const RefinedMotion& motion, const Set& fitted) const {
  return rcme::SelectFitSet(problem_, motion, fitted);
}

ReferenceMatches::Set ReferenceMatches::All() const {
  Set all(problem_.matches.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

ReferenceMatches::Set ReferenceMatches::FindConsistent(const RelativePose& pose, double threshold) const {
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(pose), problem_.camera1, problem_.camera2);
  const double bound = problem_.sigma_px * problem_.sigma_px * threshold;
  Set consistent = All();
  std::erase_if(consistent, [&](int index) {
    return !(SquaredSampsonDistance(F, problem_.matches[static_cast<size_t>(index)]) <= bound);
  });
  return consistent;
}

int ReferenceMatches::CountConsistent(const Set& set, const RelativePose& pose, double threshold) const {
  return Count(Intersect(FindConsistent(pose, threshold), set));
}

RotationEquations ReferenceMatches::LinearizeRotation(const Set& set, const Eigen::Matrix3d& R,
                                                      Loss loss) const {
  return rcme::LinearizeRotation(problem_, set, R, loss);
}

ReferenceMatches::Set ReferenceMatches::FindRotated(const Eigen::Matrix3d& R, double threshold) const {
  return rcme::FindRotated(problem_, R, threshold);
}

double ReferenceMatches::ChanceOfAgreement(const RelativePose& pose, double threshold) const {
  return rcme::ChanceOfAgreement(problem_, pose, threshold);
}

Eigen::Matrix2d ReferenceMatches::SumDirectionNoise(const Set& set, const RelativePose& pose,
                                                    const Eigen::Matrix2d& direction_cov) const {
  return rcme::SumDirectionNoise(problem_, set, pose, direction_cov);
}

ReferenceMatches::Set ReferenceMatches::Intersect(const Set& a, const Set& b) const {
  Set both;
  std::ranges::set_intersection(a, b, std::back_inserter(both));
  return both;
}

}  // namespace rcme
