#include "estimator/model_choice/orb_slam2.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "estimator/match_whitening.h"

namespace rcme {
namespace {

constexpr double kPointBound = 5.99, kLineBound = 3.84;  // T_H and T_F
constexpr double kGreatestScore = kPointBound;           // Gamma

// rho_M of the paper; 0 for an error that is NaN.
double ScoreError(double squared_error, double bound) {
  return squared_error < bound ? kGreatestScore - squared_error : 0.0;
}

double SquaredDistance(const Eigen::Vector3d& transferred, const Eigen::Vector2d& point) {
  return (transferred.hnormalized() - point).squaredNorm();
}

double SquaredDistanceFromLine(const Eigen::Vector3d& line, const Eigen::Vector2d& point) {
  const double g = line.dot(point.homogeneous());
  return g * g / line.head<2>().squaredNorm();
}

}  // namespace

double OrbSlam2HomographyScore(const MotionProblem& problem, const Eigen::Matrix3d& H) {
  const MatchWhitening whitening(problem);
  const RayScale& s = whitening.ray_scale();
  const Eigen::Vector3d scale1(s.x1, s.y1, 1.0), scale2(s.x2, s.y2, 1.0);  // whitened -> rays
  const Eigen::Matrix3d forth = scale2.cwiseInverse().asDiagonal() * H * scale1.asDiagonal();
  const Eigen::Matrix3d back = forth.inverse();
  double score = 0.0;
  for (const Correspondence& match : problem.matches) {
    const Eigen::Vector2d x1 = whitening.WhitenPoint1(match.x1_px), x2 = whitening.WhitenPoint2(match.x2_px);
    score += ScoreError(SquaredDistance(back * x2.homogeneous(), x1), kPointBound);
    score += ScoreError(SquaredDistance(forth * x1.homogeneous(), x2), kPointBound);
  }
  return score;
}

double OrbSlam2EpipolarScore(const MotionProblem& problem, const Eigen::Matrix3d& E) {
  const MatchWhitening whitening(problem);
  const Eigen::Matrix3d F = whitening.FundamentalFromEssential(E);
  double score = 0.0;
  for (const Correspondence& match : problem.matches) {
    const Eigen::Vector2d x1 = whitening.WhitenPoint1(match.x1_px), x2 = whitening.WhitenPoint2(match.x2_px);
    score += ScoreError(SquaredDistanceFromLine(F * x1.homogeneous(), x2), kLineBound);
    score += ScoreError(SquaredDistanceFromLine(F.transpose() * x2.homogeneous(), x1), kLineBound);
  }
  return score;
}

}  // namespace rcme
