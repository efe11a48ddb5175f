#include "estimator/robust_covariance/robust_covariance.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "estimator/kernels/block_matches.h"
#include "estimator/kernels/mixture_sums.h"
#include "estimator/kernels/sampson_equations.h"
#include "estimator/refinement/sampson_equations.h"
#include "estimator/robust_covariance/clustered_covariance.h"
#include "estimator/uncertainty/motion_covariance.h"
#include "stats/order_statistic.h"

namespace rcme {
namespace {

constexpr int kBlocksPerSide = 8, kJackknifeBlocksPerSide = 4;
// For the sandwich of blocks, which is 1.13 times too large if there is no correlation.
constexpr double kLeastEffect = 1.25;
constexpr int kMostRefits = 10;
constexpr double kNormalQuartile = 0.6744897501960817;  // median of |Z|
constexpr double kLeastPivot = 1e-4;  // of the triangle of an information, relative to the greatest
constexpr size_t kLeastFitted = 6;    // five matches determine a motion exactly

std::vector<Correspondence> SelectMatches(const MotionProblem& problem, std::span<const int> indices) {
  std::vector<Correspondence> matches;
  for (const int i : indices) matches.push_back(problem.matches[static_cast<size_t>(i)]);
  return matches;
}

// The matches of a problem, and the problem with the noise of its own residuals.
class AgreeingSearch {
 public:
  explicit AgreeingSearch(const MotionProblem& problem)
      : assumed_sigma_px_(problem.sigma_px), with_own_noise_(problem), matches_(problem) {}

  // The matches that agree with a motion that was fitted to `fitted`; none if `fitted` determines no motion.
  std::vector<int> FindAgreeing(const RelativePose& pose, const std::vector<int>& fitted);
  RefinedMotion Refine(const std::vector<int>& fitted, const RelativePose& start) const {
    return RefineBySampson(matches_, MakeMask(fitted, matches_), start, Loss::kSquared);
  }

 private:
  double EstimateSigma(const std::vector<int>& fitted, const RelativePose& pose);

  double assumed_sigma_px_;
  MotionProblem with_own_noise_;
  MatchBlocks matches_;
  MatchTermLists terms_;
};

// From the median of the residuals' absolute values, px.
double AgreeingSearch::EstimateSigma(const std::vector<int>& fitted, const RelativePose& pose) {
  EvaluateTerms(matches_, pose, &terms_);
  std::vector<double> sizes;
  sizes.reserve(fitted.size());
  for (const int i : fitted) sizes.push_back(std::abs(terms_.residual[static_cast<size_t>(i)]));
  return assumed_sigma_px_ * ValueOfRank(sizes.size() / 2, &sizes) / kNormalQuartile;
}

// First-order covariance of a motion that was fitted to equally weighted matches. Uses the normal equations
// if their inverse keeps eight digits.
std::optional<Matrix5d> ComputeFitCovariance(const MotionProblem& problem, const MatchBlocks& matches,
                                             const RelativePose& pose, const std::vector<int>& fitted) {
  if (problem.noise_scale.empty()) {
    const Eigen::LLT<Matrix5d> llt(SampsonInformation(matches, MakeMask(fitted, matches), pose));
    const Vector5d pivots = llt.matrixLLT().diagonal();
    if (llt.info() == Eigen::Success && pivots.minCoeff() > kLeastPivot * pivots.maxCoeff()) {
      const Matrix5d covariance = llt.solve(Matrix5d::Identity());
      if (covariance.allFinite()) return covariance;
    }
  }
  return FirstOrderMotionCovariance(pose, problem.camera1, problem.camera2, SelectMatches(problem, fitted),
                                    problem.sigma_px);
}

std::vector<int> AgreeingSearch::FindAgreeing(const RelativePose& pose, const std::vector<int>& fitted) {
  with_own_noise_.sigma_px = EstimateSigma(fitted, pose);
  const MatchBlocks matches(with_own_noise_);
  const std::optional<Matrix5d> pose_cov = ComputeFitCovariance(with_own_noise_, matches, pose, fitted);
  if (!pose_cov) return {};
  const BlockMatches with_motion(with_own_noise_, matches, RefinementError::kSampson);
  return ListIndices(with_motion.SelectFitSet({true, pose, *pose_cov, 0}, MakeMask(fitted, matches)));
}

// How much greater the sandwich of blocks is than a covariance, on average over the directions; 1 if it is
// hardly greater.
double DesignEffect(const Matrix5d& covariance, const Matrix5d& of_blocks) {
  const double effect = covariance.llt().solve(of_blocks).trace() / 5.0;
  return std::isfinite(effect) && effect > kLeastEffect ? effect : 1.0;
}

// C_0 from the scores.
std::optional<Matrix5d> IndependentCovariance(const MatchScores& scores) {
  const size_t n = scores.residuals.size();
  const Matrix5d sandwich = ClusteredCovariance(scores, Separate(n));
  if (!sandwich.allFinite() || sandwich.llt().info() != Eigen::Success) return std::nullopt;
  double sum_squares = 0.0;
  for (const double r : scores.residuals) sum_squares += r * r;
  const double variance = sum_squares / static_cast<double>(n - 5);
  return 0.5 * (sandwich + variance * scores.information.llt().solve(Matrix5d::Identity()));
}

}  // namespace

std::vector<Parameter> Parameters(RobustCovarianceOptions& options) {
  return {Parameter::Real("covariance_factor", &options.factor, {1e-3, 1e3}, "",
                          "scales the robust covariance, for errors that reach across blocks"),
          Parameter::Choice<bool>(
              "covariance_jackknife", &options.adds_jackknife, {{"off", false}, {"added", true}},
              "adds the jackknife of 4x4 image blocks to the robust covariance, conservative")};
}

AgreeingFit FitAgreeing(const MotionProblem& problem, const RelativePose& pose,
                        std::span<const int> inliers) {
  const AgreeingFit as_given{pose, std::vector<int>(inliers.begin(), inliers.end())};
  AgreeingFit fit = as_given;
  AgreeingSearch search(problem);
  for (int refit = 0; refit < kMostRefits; ++refit) {
    std::vector<int> agreeing = search.FindAgreeing(fit.cam2_from_cam1, fit.fitted);
    if (agreeing.size() < kLeastFitted) return as_given;
    if (refit > 0 && agreeing == fit.fitted) break;
    const RefinedMotion refined = search.Refine(agreeing, fit.cam2_from_cam1);
    if (!refined.converged) return as_given;
    fit = {refined.cam2_from_cam1, std::move(agreeing)};
  }
  return fit;
}

std::optional<Matrix5d> RobustCovariance(const MotionProblem& problem, const RelativePose& pose,
                                         std::span<const int> inliers, const RobustCovarianceOptions& options,
                                         const std::optional<Matrix5d>& own_cov) {
  if (inliers.size() < kLeastFitted) return std::nullopt;
  const AgreeingFit fit = FitAgreeing(problem, pose, inliers);
  const RelativePose& at = fit.cam2_from_cam1;
  const MatchScores scores = ScoreFitted(problem, fit.fitted, at);
  const std::optional<Matrix5d> of_scores = IndependentCovariance(scores);
  if (!of_scores) return std::nullopt;
  const std::vector<int> key_points = KeyPointGroups(scores.matches, kKeyPointRadiusPx);
  const ResidualVariances variances =
      options.known_variances ? TakeResidualVariances(scores, key_points, *options.known_variances)
                              : FitResidualVariances(scores, key_points);
  const double own_share = variances.own / variances.Sum();
  Matrix5d covariance = own_share * own_cov.value_or(*of_scores) + variances.shared;
  const auto of_blocks = [&](int per_side) {
    return ClusteredCovariance(scores, BlockGroups(problem.camera1, scores.matches, per_side));
  };
  covariance *= options.factor * DesignEffect(covariance, of_blocks(kBlocksPerSide));
  if (!own_cov) {
    const Vector5d away = LocalCoordinates(pose, at);
    covariance += away * away.transpose();
  }
  if (options.adds_jackknife) covariance += of_blocks(kJackknifeBlocksPerSide);
  covariance += CalibrationCovariance(
      problem, options.calibration, scores.information.llt().solve(Matrix5d::Identity()),
      [&](const MotionProblem& changed) {
        return LinearizeSampson(changed, fit.fitted, at, Loss::kSquared).gradient;
      });
  if (!covariance.allFinite()) return std::nullopt;
  return covariance;
}

}  // namespace rcme
