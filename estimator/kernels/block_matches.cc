#include "estimator/kernels/block_matches.h"

#include <limits>
#include <utility>

#include "estimator/kernels/agreement.h"
#include "estimator/kernels/agreement_chance.h"
#include "estimator/kernels/direction_noise.h"
#include "estimator/kernels/rotation_bound.h"
#include "estimator/kernels/rotation_equations.h"
#include "estimator/kernels/sampson_equations.h"
#include "estimator/refinement/fit_set.h"
#include "estimator/refinement/reprojection_mle.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

MatchMask FindWithin(const MatchBlocks& matches, const RefinedMotion& motion, const MatchMask& fitted,
                     const AgreementBounds& bounds) {
  MatchMask agreeing = matches.Empty();
  const std::optional<WhitenedModel> model =
      WhitenedModel::From(matches, motion.cam2_from_cam1, motion.pose_cov);
  if (!model) return agreeing;
  FindAgreeing(matches, motion.cam2_from_cam1, model->F, VariancePolynomial(model->dF), fitted, bounds,
               &agreeing);
  return agreeing;
}

}  // namespace

RelativePose BlockMatches::SelectPose(const EssentialProjection& projection, const Set& set) const {
  return SelectPoseByCheirality(matches_, set, projection);
}

RefinedMotion BlockMatches::Refine(const Set& set, const RelativePose& start, Loss loss) const {
  return error_ == RefinementError::kReprojection
             ? RefineByReprojection(problem_, rcme::ListIndices(set), start, loss)
             : RefineBySampson(matches_, set, start, loss);
}

MatchMask BlockMatches::FindAgreeing(const RefinedMotion& motion, const Set& fitted,
                                     double significance_level) const {
  return FindWithin(
      matches_, motion, fitted,
      {ChiSquareQuantile(1, 1.0 - significance_level), std::numeric_limits<double>::infinity()});
}

MatchMask BlockMatches::SelectFitSet(const RefinedMotion& motion, const Set& fitted) const {
  return FindWithin(matches_, motion, fitted,
                    {ChiSquareQuantile(1, 1.0 - kFitSignificance), MaxLeverage(CountIn(fitted))});
}

MatchMask BlockMatches::FindConsistent(const RelativePose& pose, double threshold) const {
  InlierScan scan(matches_);
  double F[9];
  WriteRowMajor(matches_.FundamentalFromEssential(EssentialFromPose(pose)), F);
  ScanKnownPose(matches_, F, threshold, &scan);
  return std::move(scan.inliers);
}

int BlockMatches::CountConsistent(const Set& set, const RelativePose& pose, double threshold) const {
  return CountInBoth(FindConsistent(pose, threshold), set);
}

RotationEquations BlockMatches::LinearizeRotation(const Set& set, const Eigen::Matrix3d& R, Loss loss) const {
  return rcme::LinearizeRotation(matches_, set, R, loss);
}

MatchMask BlockMatches::FindRotated(const Eigen::Matrix3d& R, double threshold) const {
  InlierScan scan(matches_);
  ScanRotation(matches_, R, threshold, &scan);
  return std::move(scan.inliers);
}

double BlockMatches::ChanceOfAgreement(const RelativePose& pose, double threshold) const {
  return rcme::ChanceOfAgreement(matches_, pose, BoxOfSecondPoints(problem_), threshold);
}

int BlockMatches::BoundRotated(double threshold) const { return rcme::BoundRotated(matches_, threshold); }

Eigen::Matrix2d BlockMatches::SumDirectionNoise(const Set& set, const RelativePose& pose,
                                                const Eigen::Matrix2d& direction_cov) const {
  return rcme::SumDirectionNoise(matches_, set, pose, direction_cov);
}

}  // namespace rcme
