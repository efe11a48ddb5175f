#include "estimator/calibrated/model_check.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "estimator/calibrated/direction_posterior.h"
#include "estimator/calibrated/neighbour_matches.h"
#include "estimator/calibrated/twisted_pair.h"
#include "estimator/noise_scale.h"
#include "stats/order_statistic.h"

namespace rcme {
namespace {

constexpr size_t kMostCompared = 128;
constexpr double kCut = 3.0;         // of residuals and parallaxes, standard deviations
constexpr double kPlaneBound = 4.0;  // standard deviations of a match
// share of the information along a direction that is kept without a block
constexpr double kLeastKept = 0.05;

double LogWithin(double x, double least, double most) { return std::log(std::clamp(x, least, most)); }

// The indices of the matches that the answer explains and of the others, in their order.
struct Split {
  std::vector<size_t> right, wrong;
};
Split SplitMatches(const Explanation& explanation) {
  Split split;
  for (size_t i = 0; i < explanation.probability.size(); ++i)
    (explanation.probability[i] > 0.5 ? split.right : split.wrong).push_back(i);
  return split;
}

void CheckNeighbours(const MotionProblem& problem, const Split& split, const ExplainedMode& answer,
                     ModelCheck* check) {
  const std::vector<size_t> nearest = FindNearestNeighbours(problem, split.right, 0.0);
  const auto residual = [&](size_t place) {
    const double u = answer.explanation.terms.residual[split.right[place]] / answer.mode.mixture.scale;
    return std::clamp(u, -kCut, kCut);
  };
  double sum = 0.0, count = 0.0;
  for (size_t a = 0; a < nearest.size(); ++a) {
    if (nearest[a] == a) continue;
    sum += residual(a) * residual(nearest[a]);
    count += 1.0;
  }
  if (count == 0.0) return;
  check->neighbour_z = sum / std::sqrt(count);
}

double PlanarShare(const MotionProblem& problem, const Split& split, const ExplainedMode& answer) {
  const RelativePose& pose = answer.mode.pose;
  const std::optional<VisiblePlane> plane = FindPlane(problem, pose, answer.explanation.probability, 0.0);
  const size_t n = std::min(split.right.size(), kMostCompared);
  if (!plane || n == 0) return 0.0;
  const Eigen::Matrix3d H = pose.R + pose.t * plane->n.transpose();
  const MixtureParameters& m = answer.mode.mixture;
  const double noise_rad = problem.sigma_px * m.scale / m.noise.scale_of_gaussian *
                           std::sqrt(1.0 / (problem.camera1.fx * problem.camera1.fy) +
                                     1.0 / (problem.camera2.fx * problem.camera2.fy));
  double num_near = 0.0;
  for (size_t a = 0; a < n; ++a) {
    const size_t i = split.right[a];
    const Eigen::Vector3d moved = (H * problem.camera1.Ray(problem.matches[i].x1_px)).normalized();
    const Eigen::Vector3d seen = problem.camera2.Ray(problem.matches[i].x2_px).normalized();
    num_near += moved.dot(seen) > 0.0 &&
                moved.cross(seen).norm() < kPlaneBound * noise_rad * NoiseScaleAt(problem, i);
  }
  return num_near / static_cast<double>(n);
}

// Determinant of the scatter of some matches' points in image 1, each with the weight of its index, px^4.
template <typename Weight>
double WeightedScatterDeterminant(const MotionProblem& problem, const std::vector<size_t>& some,
                                  const Weight& weight) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double sum = 0.0;
  for (const size_t i : some) {
    mean += weight(i) * problem.matches[i].x1_px;
    sum += weight(i);
  }
  if (!(sum > 0.0)) return 0.0;
  mean /= sum;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const size_t i : some) {
    const Eigen::Vector2d away = problem.matches[i].x1_px - mean;
    scatter += weight(i) * away * away.transpose();
  }
  return (scatter / sum).determinant();
}

double ScatterDeterminant(const MotionProblem& problem, const std::vector<size_t>& some) {
  return WeightedScatterDeterminant(problem, some, [](size_t) { return 1.0; });
}

// ln of the ratio of lengths of two scatters, at least a square pixel each.
double LogRelativeSpread(double determinant, double of_determinant) {
  return std::clamp(0.25 * std::log((determinant + 1.0) / (of_determinant + 1.0)), -2.0, 1.0);
}

void CheckSpread(const MotionProblem& problem, const Split& split, const ExplainedMode& answer,
                 ModelCheck* check) {
  const std::vector<double>& depth = answer.explanation.terms.depth;
  std::vector<size_t> all(problem.matches.size()), near;
  for (size_t i = 0; i < all.size(); ++i) all[i] = i;
  for (const size_t i : split.right) {
    if (depth[i] >= kCut * answer.mode.mixture.scale) near.push_back(i);
  }
  const double of_right = ScatterDeterminant(problem, split.right);
  check->spread_in_matches = LogRelativeSpread(of_right, ScatterDeterminant(problem, all));
  check->near_in_right = LogRelativeSpread(ScatterDeterminant(problem, near), of_right);
  check->parallax_spread = LogRelativeSpread(
      WeightedScatterDeterminant(problem, near, [&](size_t i) { return depth[i] * depth[i]; }), of_right);
}

void CheckSides(const MotionProblem& problem, const ExplainedMode& answer, ModelCheck* check) {
  const double bound = kCut * answer.mode.mixture.scale;
  const MatchTermLists& terms = answer.explanation.terms;
  double in_front = 0.5, behind = 0.5;
  for (size_t i = 0; i < problem.matches.size(); ++i) {
    if (!(std::abs(terms.residual[i]) < bound)) continue;
    in_front += terms.depth[i] > bound;
    behind += terms.depth[i] < -bound;
  }
  check->log_behind = std::log(behind / in_front);
}

// Sums over the right matches in a block of image 1.
struct BlockSums {
  double num_matches = 0.0;
  Vector5d score = Vector5d::Zero();
  Matrix5d information = Matrix5d::Zero();
  double parallax = 0.0;  // sum z^2, z > 0

  void Add(const BlockSums& other) {
    num_matches += other.num_matches;
    score += other.score;
    information += other.information;
    parallax += other.parallax;
  }
};

constexpr int kPerSide = 4;
struct Blocks {
  std::array<BlockSums, kPerSide * kPerSide> sums;  // by column of blocks, then row
  Matrix5d scatter = Matrix5d::Zero();              // of the scores of single matches
};

Blocks SumBlocks(const MotionProblem& problem, const Split& split, const ExplainedMode& answer) {
  const Explanation& e = answer.explanation;
  const MixtureParameters& m = answer.mode.mixture;
  const auto block = [&](double x_px, int length_px) {
    return std::clamp(static_cast<int>((x_px + 0.5) / length_px * kPerSide), 0, kPerSide - 1);
  };
  Blocks blocks;
  for (const size_t i : split.right) {
    const Eigen::Vector2d& x = problem.matches[i].x1_px;
    BlockSums& sums = blocks.sums[static_cast<size_t>(block(x.x(), problem.camera1.width) * kPerSide +
                                                      block(x.y(), problem.camera1.height))];
    Vector5d J;
    for (size_t k = 0; k < 5; ++k) J(static_cast<Eigen::Index>(k)) = e.terms.derivative[k][i];
    const double u = e.terms.residual[i] / m.scale, weight = e.probability[i] * NoiseWeight(m.noise, u);
    const Matrix5d outer = J * J.transpose();
    sums.num_matches += 1.0;
    sums.score += weight * u * J;
    sums.information += weight * outer;
    sums.parallax += std::pow(std::max(e.terms.depth[i] / m.scale, 0.0), 2);
    blocks.scatter += weight * weight * u * u * outer;
  }
  return blocks;
}

// ln of the design effect of `per_side` x `per_side` blocks; per_side is 2 or 4. Scores and information are
// whitened by the information of all matches. Leaving out a block with score s and information A moves the
// motion by (1.05 I - A)^-1 s, so at most twenty times the score.
double LogDesignEffect(const Blocks& blocks, int per_side) {
  std::array<BlockSums, kPerSide * kPerSide> joined;
  BlockSums all;
  for (int k = 0; k < kPerSide * kPerSide; ++k) {
    const int column = k / kPerSide * per_side / kPerSide, row = k % kPerSide * per_side / kPerSide;
    joined[static_cast<size_t>(column * per_side + row)].Add(blocks.sums[static_cast<size_t>(k)]);
    all.Add(blocks.sums[static_cast<size_t>(k)]);
  }
  const Eigen::LLT<Matrix5d> llt(all.information);
  if (llt.info() != Eigen::Success) return 0.0;
  const Matrix5d whitening = llt.matrixL().solve(Matrix5d::Identity());
  double moved = 0.0;
  for (const BlockSums& sums : joined) {
    if (sums.num_matches == 0.0) continue;
    const Matrix5d kept =
        (1.0 + kLeastKept) * Matrix5d::Identity() - whitening * sums.information * whitening.transpose();
    moved += kept.llt().solve(whitening * sums.score).squaredNorm();
  }
  const double own = (whitening * blocks.scatter * whitening.transpose()).trace();
  return own > 0.0 ? LogWithin(moved / own, 0.1, 1e3) : 0.0;
}

double LogParallaxShare(const Blocks& blocks) {
  double sum = 0.0, sum_squares = 0.0, count = 0.0;
  for (const BlockSums& sums : blocks.sums) {
    sum += sums.parallax;
    sum_squares += sums.parallax * sums.parallax;
    count += sums.num_matches > 0.0;
  }
  return sum_squares > 0.0 ? LogWithin(sum * sum / (sum_squares * count), 0.01, 1.0) : 0.0;
}

void CheckBlocks(const MotionProblem& problem, const Split& split, const ExplainedMode& answer,
                 ModelCheck* check) {
  const Blocks blocks = SumBlocks(problem, split, answer);
  check->log_design_2 = LogDesignEffect(blocks, 2);
  check->log_design_4 = LogDesignEffect(blocks, 4);
  check->log_parallax_share = LogParallaxShare(blocks);
}

double LowDepth(const Split& split, const ExplainedMode& answer) {
  std::vector<double> depths;
  for (const size_t i : split.right) depths.push_back(answer.explanation.terms.depth[i]);
  if (depths.empty()) return 0.0;
  const size_t rank = depths.size() / 20;
  return std::clamp(ValueOfRank(rank, &depths) / answer.mode.mixture.scale, -3.0, 3.0);
}

void CheckRightMatches(const Split& split, const ExplainedMode& answer, ModelCheck* check) {
  if (split.right.empty()) return;
  const Explanation& e = answer.explanation;
  double probability = 0.0, gain = 0.0;
  for (const size_t i : split.right) {
    probability += e.probability[i];
    gain += std::log(e.inlier_density[i] / WrongDensity(e, i, answer.mode.mixture.outlier_density));
    check->greatest_leverage = std::max(check->greatest_leverage, e.leverage[i]);
  }
  check->mean_probability = probability / static_cast<double>(split.right.size());
  check->mean_gain = std::clamp(gain / static_cast<double>(split.right.size()), 0.0, 8.0);
}

void CheckRivals(const ModeWeights& weights, ModelCheck* check) {
  for (size_t i = 0; i < weights.of_modes.size(); ++i) {
    if (weights.is_rival[i]) check->greatest_rival = std::max(check->greatest_rival, weights.of_modes[i]);
  }
}

}  // namespace

ModelCheck CheckModel(const MotionProblem& problem, const std::vector<ExplainedMode>& modes,
                      const ModeWeights& weights) {
  const ExplainedMode& answer = modes[weights.answer];
  const MixtureParameters& m = answer.mode.mixture;
  const Split split = SplitMatches(answer.explanation);
  ModelCheck check;
  check.log_noise_ratio = std::log(m.scale / m.noise.scale_of_gaussian);
  CheckNeighbours(problem, split, answer, &check);
  check.planar_share = PlanarShare(problem, split, answer);
  CheckSpread(problem, split, answer, &check);
  CheckSides(problem, answer, &check);
  CheckBlocks(problem, split, answer, &check);
  check.log_num_right = LogWithin(static_cast<double>(split.right.size()), 1.0, 1e9);
  check.wrong_share = static_cast<double>(split.wrong.size()) / static_cast<double>(problem.matches.size());
  check.wrong_coherence = ComputeCoherence(problem, split.wrong);
  CheckRightMatches(split, answer, &check);
  check.log_rotation_sd =
      LogWithin(std::sqrt(answer.mode.inverse_hessian.topLeftCorner<3, 3>().trace()), 1e-6, 3.0);
  CheckRivals(weights, &check);
  check.low_depth = LowDepth(split, answer);
  check.usual_depth = UsualDepthInNoise(answer.explanation);
  check.calibration = CheckIntrinsics(problem, answer.mode, answer.explanation);
  check.partner_dependence = FindPartnerDependence(problem, answer.mode.pose, split.right);
  return check;
}

}  // namespace rcme
