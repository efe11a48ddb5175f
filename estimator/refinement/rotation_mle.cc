#include "estimator/refinement/rotation_mle.h"

#include <Eigen/Cholesky>

#include "estimator/kernels/rotation_equations.h"

namespace rcme {
namespace {

constexpr int kMaxSteps = 10, kMaxRefits = 10;

// Reweighted least squares, to a step of 0.001 standard deviations; of 0.1 with Cauchy's loss, which serves
// to tell the wrong matches.
Eigen::Matrix3d Descend(const MatchBlocks& matches, const MatchMask& mask, Eigen::Matrix3d R, Loss loss) {
  const double negligible = loss == Loss::kCauchy ? 1e-2 : 1e-6;
  for (int i = 0; i < kMaxSteps; ++i) {
    const RotationEquations at = LinearizeRotation(matches, mask, R, loss);
    const Eigen::Vector3d step = -at.hessian.llt().solve(at.gradient);
    if (!step.allFinite()) return R;
    R = RotationFromVector(step) * R;
    if (-step.dot(at.gradient) < negligible) return R;
  }
  return R;
}

MatchMask InBoth(const MatchMask& a, const MatchMask& b) {
  MatchMask both(a.size());
  for (size_t i = 0; i < a.size(); ++i) both[i] = a[i] & b[i];
  return both;
}

}  // namespace

RotationFit FitRotation(const MatchBlocks& matches, const MatchMask& set, const Eigen::Matrix3d& start,
                        double threshold) {
  RotationFit fit;
  fit.R = Descend(matches, set, start, Loss::kCauchy);
  InlierScan scan(matches);
  for (int refit = 0; refit < kMaxRefits; ++refit) {
    ScanRotation(matches, fit.R, threshold, &scan);
    MatchMask selected = InBoth(scan.inliers, set);
    const bool is_same = refit > 0 && selected == fit.fitted;
    fit.within = scan.inliers;
    fit.fitted = std::move(selected);
    if (is_same) break;
    if (CountIn(fit.fitted) < 3) {
      fit.fitted = matches.Empty();
      break;
    }
    fit.R = Descend(matches, fit.fitted, fit.R, Loss::kSquared);
  }
  const RotationEquations at = LinearizeRotation(matches, fit.fitted, fit.R, Loss::kSquared);
  fit.energy = at.energy;
  fit.rotation_cov = at.hessian.llt().solve(Eigen::Matrix3d::Identity());
  return fit;
}

}  // namespace rcme
