#include "estimator/motion_chance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/match_whitening.h"
#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

struct Chord {
  Eigen::Vector2d start, end;
};

// The part of the line l' [x; 1] = 0 in the box.
std::optional<Chord> ClipLine(const Eigen::Vector3d& l, const Box& box) {
  const Eigen::Vector2d normal = l.head<2>(), along(-normal.y(), normal.x());
  const Eigen::Vector2d foot = -l.z() / normal.squaredNorm() * normal;
  double from = -std::numeric_limits<double>::infinity(), to = -from;
  for (int axis = 0; axis < 2; ++axis) {
    if (along(axis) == 0.0) {
      if (foot(axis) < box.low[axis] || foot(axis) > box.high[axis]) return std::nullopt;
      continue;
    }
    const double a = (box.low[axis] - foot(axis)) / along(axis),
                 b = (box.high[axis] - foot(axis)) / along(axis);
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  if (!(from < to)) return std::nullopt;
  return Chord{foot + from * along, foot + to * along};
}

// Area, within the box, of the band g^2 <= threshold (|l1|^2 + |l2|^2) around the line l2 = F x1. Its width
// is 2 sqrt(threshold (1 + |l1|^2 / |l2|^2)), l1 the first two entries of F'x2. Integrated by Simpson's rule
// along the chord.
double AreaOfBand(const Eigen::Matrix3d& F, const Eigen::Vector2d& x1, double threshold, const Box& box) {
  const Eigen::Vector3d l2 = F * x1.homogeneous();
  const double norm2 = l2.head<2>().squaredNorm();
  if (!(norm2 > 0.0)) return box.Area();  // x1 is the epipole: any point agrees
  const std::optional<Chord> chord = ClipLine(l2, box);
  if (!chord) return 0.0;
  const auto width = [&](const Eigen::Vector2d& x2) {
    const Eigen::Vector2d l1 = (F.transpose() * x2.homogeneous()).head(2);
    return 2.0 * std::sqrt(threshold * (1.0 + l1.squaredNorm() / norm2));
  };
  const double mean =
      (width(chord->start) + 4.0 * width(0.5 * (chord->start + chord->end)) + width(chord->end)) / 6.0;
  return mean * (chord->end - chord->start).norm();
}

// log P(Bin(n, p) >= k), or Chernoff's bound of it if the probability is too small for a double.
double LogUpperTail(int n, int k, double p) {
  const double tail = BinomialUpperTail(n, k, p), share = static_cast<double>(k) / n;
  if (tail > 1e-280) return std::log(tail);
  const double other_terms = k < n ? (1.0 - share) * std::log((1.0 - share) / (1.0 - p)) : 0.0;
  return -n * (share * std::log(share / p) + other_terms);
}

}  // namespace

Box BoxOfSecondPoints(const MotionProblem& problem) {
  const Camera& camera = problem.camera2;
  double low_x = kInfinity, low_y = kInfinity, high_x = -kInfinity, high_y = -kInfinity;
  for (const Correspondence& match : problem.matches) {
    if (!camera.IsInImage(match.x2_px)) continue;
    low_x = std::min(low_x, match.x2_px.x());
    low_y = std::min(low_y, match.x2_px.y());
    high_x = std::max(high_x, match.x2_px.x());
    high_y = std::max(high_y, match.x2_px.y());
  }
  if (!(low_x < high_x && low_y < high_y)) {  // no two points in the image
    low_x = low_y = -0.5;
    high_x = camera.width - 0.5;
    high_y = camera.height - 0.5;
  }
  return {{(low_x - camera.cx) / problem.sigma_px, (low_y - camera.cy) / problem.sigma_px},
          {(high_x - camera.cx) / problem.sigma_px, (high_y - camera.cy) / problem.sigma_px}};
}

double ChanceOfAgreement(const MotionProblem& problem, const RelativePose& pose, double threshold) {
  const MatchWhitening whitening(problem);
  const Eigen::Matrix3d F = whitening.FundamentalFromEssential(EssentialFromPose(pose));
  const Box box = BoxOfSecondPoints(problem);
  const int n = static_cast<int>(problem.matches.size()), stride = (n + kMostLookedAt - 1) / kMostLookedAt;
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < n; i += stride, ++count) {
    const Eigen::Vector2d x1 = whitening.WhitenPoint1(problem.matches[static_cast<size_t>(i)].x1_px);
    sum += std::min(1.0, AreaOfBand(F, x1, threshold, box) / box.Area());
  }
  return sum / count;
}

double ChanceOfAgreementWithRotation(const MotionProblem& problem, double threshold) {
  const RayScale s = MatchWhitening(problem).ray_scale();
  // det C at the image's middle: C = I + J J', J the ratio of the focal lengths
  const double det = (1.0 + std::pow(s.x1 / s.x2, 2)) * (1.0 + std::pow(s.y1 / s.y2, 2));
  return ChanceOfAgreementInEllipse(problem, threshold, std::sqrt(det));
}

double ChanceOfAgreementInEllipse(const MotionProblem& problem, double threshold, double root_det) {
  return std::min(1.0, std::numbers::pi * threshold * root_det / BoxOfSecondPoints(problem).Area());
}

double LogFalseAlarms(const ModelFamily& family, int num_matches, int num_agreeing, double chance) {
  const int m = family.num_fixing;
  if (num_agreeing <= m) return std::numeric_limits<double>::infinity();
  double log_models = std::log(family.most_per_choice);
  for (int i = 0; i < m; ++i) log_models += std::log((num_matches - i) / (i + 1.0));  // C(n, m)
  return log_models + LogUpperTail(num_matches - m, num_agreeing - m, chance);
}

}  // namespace rcme
