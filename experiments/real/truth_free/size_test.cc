#include "experiments/real/truth_free/size_test.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "estimator/robust_covariance/clustered_covariance.h"
#include "stats/constants.h"

namespace rcme {
namespace {

constexpr double kConfidenceOfSlope = 0.95;
constexpr size_t kLeastOfSlope = 20;   // inliers
constexpr double kLeastSpread = 0.01;  // of log noise_scale^2, mean square

}  // namespace

double SlopeScore(const MotionProblem& problem, const MotionEstimate& estimate) {
  const std::vector<int>& inliers = estimate.inliers;
  if (problem.noise_scale.empty() || inliers.size() < kLeastOfSlope) return kNaN;
  const MotionProblem unscaled{problem.matches, problem.camera1, problem.camera2, 1.0};
  const MatchScores scores = ScoreFitted(unscaled, inliers, estimate.cam2_from_cam1);
  const Eigen::LDLT<Matrix5d> ldlt(scores.information);
  std::vector<double> x, y;
  double mean_x = 0.0, spread = 0.0, sum = 0.0;
  for (size_t k = 0; k < inliers.size(); ++k) {
    const double leverage = scores.rows[k].dot(ldlt.solve(scores.rows[k]));
    const double squared = scores.residuals[k] * scores.residuals[k] / std::max(1.0 - leverage, 0.05);
    if (!(squared > 0.0)) continue;
    x.push_back(2.0 * std::log(problem.noise_scale[static_cast<size_t>(inliers[k])]));
    y.push_back(std::log(squared));
    mean_x += x.back();
  }
  mean_x /= static_cast<double>(x.size());
  for (size_t k = 0; k < x.size(); ++k) {
    spread += (x[k] - mean_x) * (x[k] - mean_x);
    sum += (x[k] - mean_x) * y[k];
  }
  return spread > kLeastSpread * static_cast<double>(x.size()) ? sum : kNaN;
}

SizeReport TestKeyPointSizes(const std::vector<PairAnswers>& answers) {
  const std::vector<ImageNumbers> images = NumberImages(answers);
  std::vector<UnitScore> units;
  for (size_t i = 0; i < answers.size(); ++i) {
    const auto score_of = [](const Answered& of) {
      return of.IsOk() ? SlopeScore(of.pair.problem, of.estimate) : kNaN;
    };
    const double score = score_of(answers[i].whole);
    double of_twins = 0.0, num_twins = 0.0;
    for (const Answered& twin : answers[i].twins) {
      const double of_twin = score_of(twin);
      if (std::isfinite(of_twin)) of_twins += of_twin, num_twins += 1.0;
    }
    if (!std::isfinite(score) || num_twins == 0.0) continue;
    units.push_back({images[i].image1, images[i].image2, Eigen::VectorXd::Constant(1, score),
                     Eigen::MatrixXd::Constant(1, 1, of_twins / num_twins)});
  }
  SizeReport report;
  report.num_pairs = static_cast<int>(units.size());
  report.slope = PoolScoreAlone(units, 0, kConfidenceOfSlope);
  if (!std::isnan(report.slope.value))
    report.verdict =
        VerdictOnInterval(report.slope.interval, 1.0, {1.0 - kNominalSlope, 1.0 + kNominalSlope});
  return report;
}

std::string DescribeSizeTest(const SizeReport& report) {
  if (report.verdict != TruthFreeVerdict::kNoData && !std::isfinite(report.slope.interval.lower))
    return fmt::format("undecided: {} pairs are too few for an interval", report.num_pairs);
  const std::string range = fmt::format("{:.2g} [{:.2g}, {:.2g}]", report.slope.value,
                                        report.slope.interval.lower, report.slope.interval.upper);
  switch (report.verdict) {
    case TruthFreeVerdict::kNoData:
      return "no data";
    case TruthFreeVerdict::kHolds:
      return "holds: grows by " + range + " of what is stated";
    case TruthFreeVerdict::kUndecided:
      return "undecided: grows by " + range + " of what is stated";
    default:
      return "grows by " + range + " of what is stated";
  }
}

}  // namespace rcme
