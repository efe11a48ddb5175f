#include "estimator/robust_covariance/residual_variances.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <numeric>

#include "estimator/kernels/correlated_pairs.h"

namespace rcme {
namespace {

constexpr Eigen::Index kNumLengths = kNumCorrelationLengths;
constexpr double kLongestPx = kNeighbourLengthsPx.back();  // the others are a third and a ninth
constexpr int kOwn = 0, kKeyPoint = 1, kFirstLength = 2, kNumParts = kNumVarianceParts;
constexpr size_t kMostKeyPoints = 1500;
constexpr double kLeastPairs = 1.0;     // least evidence for a part, in full pairs
constexpr double kLeastDeviance = 1.0;  // half of what Akaike's criterion demands per parameter

using Parts = ResidualMoments::Parts;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, 5>;

// The n selected of N key points, and the rows of U of their matches.
struct KeyPoints {
  double share_kept = 1.0;  // n / N
  std::vector<Correspondence> at;
  std::vector<Eigen::Vector4d> normals;
  Eigen::VectorXd num_matches, residuals, mean_squares;  // n each; mean and mean square of the residuals
  Rows sums, means;                                      // n x 5, of the rows
  // Three sums. U' U: over the matches, of U_i' U_i. U' W_0 U: the same, divided by the number of matches of
  // the key point. U' W_1 U: over pairs of different matches of a key point, divided by the number of its
  // pairs.
  Matrix5d squares = Matrix5d::Zero(), within = Matrix5d::Zero(), between = Matrix5d::Zero();

  Eigen::Index size() const { return num_matches.size(); }
};

// Selects evenly spaced key points, few enough to visit their pairs. Returns the place of each, or -1.
std::vector<Eigen::Index> SelectPlaces(size_t num_points) {
  std::vector<Eigen::Index> places(num_points, -1);
  const size_t num_kept = std::min(num_points, kMostKeyPoints);
  for (size_t i = 0; i < num_kept; ++i) places[i * num_points / num_kept] = static_cast<Eigen::Index>(i);
  return places;
}

KeyPoints SelectKeyPoints(const MatchScores& scores, std::span<const int> groups, const Matrix5d& L) {
  const std::vector<Eigen::Index> places =
      SelectPlaces(1 + static_cast<size_t>(*std::ranges::max_element(groups)));
  const auto n = static_cast<Eigen::Index>(std::min(places.size(), kMostKeyPoints));
  KeyPoints points;
  points.share_kept = static_cast<double>(n) / static_cast<double>(places.size());
  points.at.resize(static_cast<size_t>(n));
  points.normals.resize(static_cast<size_t>(n));
  points.num_matches = points.residuals = points.mean_squares = Eigen::VectorXd::Zero(n);
  points.sums = Rows::Zero(n, 5);
  std::vector<Vector5d> rows(groups.size());
  for (size_t i = 0; i < groups.size(); ++i) {
    const Eigen::Index g = places[static_cast<size_t>(groups[i])];
    if (g < 0) continue;
    if (points.num_matches(g) == 0.0) {
      points.at[static_cast<size_t>(g)] = scores.matches[i];
      points.normals[static_cast<size_t>(g)] = scores.normals[i];
    }
    rows[i] = L.triangularView<Eigen::Lower>().solve(scores.rows[i]);
    points.num_matches(g) += 1.0;
    points.residuals(g) += scores.residuals[i];
    points.mean_squares(g) += scores.residuals[i] * scores.residuals[i];
    points.sums.row(g) += rows[i];
  }
  for (size_t i = 0; i < groups.size(); ++i) {
    const Eigen::Index g = places[static_cast<size_t>(groups[i])];
    if (g < 0) continue;
    const double m = points.num_matches(g);
    const Matrix5d square = rows[i] * rows[i].transpose();
    points.squares += square;
    points.within += square / m;
    if (m > 1.0) points.between -= square / (m * (m - 1.0));
  }
  for (Eigen::Index g = 0; g < n; ++g) {
    const double m = points.num_matches(g);
    if (m > 1.0) points.between += points.sums.row(g).transpose() * points.sums.row(g) / (m * (m - 1.0));
  }
  points.residuals.array() /= points.num_matches.array();
  points.mean_squares.array() /= points.num_matches.array();
  points.means = points.num_matches.cwiseInverse().asDiagonal() * points.sums;
  return points;
}

// Sums over pairs of different key points (kernels/correlated_pairs.h). They take nearly all of the time.
struct PairSums {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();   // of c_k c_l
  Eigen::Matrix3d weighted = Eigen::Matrix3d::Zero();  // divided by both numbers of matches
  Eigen::Vector3d products = Eigen::Vector3d::Zero();  // of c_k times both residuals
  // row g: sum over h of c_gh times the sum, or the mean, of the rows of h
  std::array<Rows, kNumLengths> sums, means;
};

// The order of the key points: those with several matches first.
std::vector<Eigen::Index> OrderByRepetition(const KeyPoints& points) {
  std::vector<Eigen::Index> order(points.at.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_partition(order.begin(), order.end(),
                        [&](Eigen::Index g) { return points.num_matches(g) > 1.0; });
  return order;
}

std::vector<CorrelatedBlock> PackKeyPoints(const KeyPoints& points, const std::vector<Eigen::Index>& order) {
  std::vector<CorrelatedBlock> blocks((order.size() + kBlockSize - 1) / kBlockSize);
  for (size_t place = 0; place < order.size(); ++place) {
    CorrelatedBlock& block = blocks[place / kBlockSize];
    const size_t lane = place % kBlockSize;
    const Eigen::Index g = order[place];
    const Correspondence& at = points.at[static_cast<size_t>(g)];
    const double x_px[4] = {at.x1_px.x(), at.x1_px.y(), at.x2_px.x(), at.x2_px.y()};
    for (Eigen::Index i = 0; i < 4; ++i) {
      block.at[i][lane] = x_px[i] / (kDistanceUnit * kLongestPx);
      block.normal[i][lane] = points.normals[static_cast<size_t>(g)](i);
    }
    block.residual[lane] = points.residuals(g);
    block.weight[lane] = 1.0 / points.num_matches(g);
    for (Eigen::Index j = 0; j < 5; ++j) {
      block.row[j][lane] = points.sums(g, j);
      block.excess[j][lane] = (block.weight[lane] - 1.0) * points.sums(g, j);
    }
  }
  return blocks;
}

Eigen::Matrix3d TwiceTheSymmetric(const double* triangle) {
  Eigen::Matrix3d matrix;
  for (int row = 0, i = 0; row < 3; ++row) {
    for (int column = 0; column <= row; ++column, ++i)
      matrix(row, column) = matrix(column, row) = 2.0 * triangle[i];
  }
  return matrix;
}

PairSums VisitPairs(const KeyPoints& points) {
  const std::vector<Eigen::Index> order = OrderByRepetition(points);
  const auto num_repeated = static_cast<size_t>((points.num_matches.array() > 1.0).count());
  const CorrelatedPairSums visited = SumCorrelatedPairs(PackKeyPoints(points, order), num_repeated);
  PairSums pairs{TwiceTheSymmetric(visited.squares),
                 TwiceTheSymmetric(visited.weighted),
                 2.0 * Eigen::Vector3d::Map(visited.products),
                 {},
                 {}};
  for (size_t k = 0; k < kNumLengths; ++k) {
    pairs.sums[k].resize(points.size(), 5);
    pairs.means[k].resize(points.size(), 5);
    for (size_t place = 0; place < order.size(); ++place) {
      const SmoothedBlock& block = visited.smoothed[place / kBlockSize];
      for (Eigen::Index j = 0; j < 5; ++j) {
        pairs.sums[k](order[place], j) = block.row[k][j][place % kBlockSize];
        pairs.means[k](order[place], j) = block.mean[k][j][place % kBlockSize];
      }
    }
  }
  return pairs;
}

ResidualMoments ComputeMoments(const KeyPoints& points) {
  const PairSums pairs = VisitPairs(points);
  const Eigen::ArrayXd m = points.num_matches.array(), is_repeated = (m > 1.0).cast<double>();
  const Eigen::ArrayXd num_pairs = (m * (m - 1.0)).max(1.0);
  const Matrix5d* of_weights[kNumParts] = {&points.within, &points.between};  // U' W_a U
  std::array<Matrix5d, kNumLengths> of_lengths;
  ResidualMoments moments;
  moments.q(kOwn) = points.mean_squares.sum();
  moments.q(kKeyPoint) =
      (is_repeated * (m.square() * points.residuals.array().square() - m * points.mean_squares.array()) /
       num_pairs)
          .sum();
  moments.q.tail<kNumLengths>() = pairs.products;
  moments.M(kOwn, kOwn) = m.inverse().sum();
  moments.M(kKeyPoint, kKeyPoint) = (is_repeated / num_pairs).sum();
  moments.M.bottomRightCorner<kNumLengths, kNumLengths>() = pairs.weighted;
  moments.T.bottomRightCorner<kNumLengths, kNumLengths>() = pairs.squares;
  for (size_t k = 0; k < kNumLengths; ++k) {
    of_lengths[k] = points.means.transpose() * pairs.means[k];
    of_weights[kFirstLength + k] = &of_lengths[k];
  }
  moments.G[kOwn] = points.squares / points.share_kept;
  moments.T(kOwn, kOwn) = static_cast<double>(points.size());
  for (int a = kOwn; a < kNumParts; ++a) moments.T(a, kOwn) -= of_weights[a]->trace();
  for (int b = kKeyPoint; b < kNumParts; ++b) {
    Rows smooth = points.sums;  // K_b U, for a match of each key point
    if (b >= kFirstLength) smooth += pairs.sums[static_cast<size_t>(b - kFirstLength)] / points.share_kept;
    const Matrix5d G = points.sums.transpose() * smooth / points.share_kept;
    const Eigen::ArrayXd left = 1.0 - 2.0 * smooth.cwiseProduct(points.means).rowwise().sum().array();
    moments.T(kOwn, b) = left.sum();
    moments.T(kKeyPoint, b) = (is_repeated * left).sum();
    for (int a = kFirstLength; a < kNumParts; ++a)
      moments.T(a, b) -= 2.0 * pairs.means[static_cast<size_t>(a - kFirstLength)].cwiseProduct(smooth).sum();
    for (int a = kOwn; a < kNumParts; ++a) moments.T(a, b) += of_weights[a]->cwiseProduct(G).sum();
    moments.G[static_cast<size_t>(b)] = G;
  }
  return moments;
}

// Least squares of q - T v over v >= 0, and its improvement over v_0 alone.
struct Solution {
  Parts v = Parts::Zero();
  double deviance = 0.0;
};
Solution SolveMoments(const ResidualMoments& moments) {
  std::vector<int> known;  // parts for which there is evidence
  for (int a = kOwn; a < kNumParts; ++a) {
    if (moments.M(a, a) >= kLeastPairs || a == kOwn) known.push_back(a);
  }
  const Eigen::MatrixXd T = moments.T(known, known);
  const Eigen::MatrixXd weighted = Eigen::MatrixXd(moments.M(known, known)).ldlt().solve(T);
  const Eigen::MatrixXd normal = T.transpose() * weighted;
  const Eigen::VectorXd right = weighted.transpose() * Eigen::VectorXd(moments.q(known));
  Solution best;
  best.v(kOwn) = right(0) / normal(0, 0);
  const double variance = best.v(kOwn), alone = right(0) * variance;
  for (unsigned chosen = 1; chosen < 1u << (known.size() - 1); ++chosen) {
    std::vector<int> active = {0};
    for (size_t k = 1; k < known.size(); ++k) {
      if ((chosen >> (k - 1) & 1u) != 0) active.push_back(static_cast<int>(k));
    }
    const Eigen::VectorXd v =
        Eigen::MatrixXd(normal(active, active)).ldlt().solve(Eigen::VectorXd(right(active)));
    if (!(v.minCoeff() >= 0.0)) continue;
    const double deviance = (right(active).dot(v) - alone) / (2.0 * variance * variance);
    if (!(deviance > std::max(best.deviance, kLeastDeviance))) continue;
    best = {Parts::Zero(), deviance};
    for (size_t k = 0; k < active.size(); ++k)
      best.v(known[static_cast<size_t>(active[k])]) = v(static_cast<Eigen::Index>(k));
  }
  return best;
}

// Removes negative eigenvalues, which the selection of key points may cause.
Matrix5d Nonnegative(const Matrix5d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(Matrix5d(0.5 * (matrix + matrix.transpose())));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

// Computes `shared` from the parts v.
void SetShared(const Parts& v, const ResidualMoments& moments, const Matrix5d& L,
               ResidualVariances* variances) {
  Matrix5d middle = Matrix5d::Zero();
  for (int b = kKeyPoint; b < kNumParts; ++b) middle += v(b) * moments.G[static_cast<size_t>(b)];
  const Matrix5d half = L.transpose().triangularView<Eigen::Upper>().solve(Nonnegative(middle));
  variances->shared = L.transpose().triangularView<Eigen::Upper>().solve(half.transpose());
}

}  // namespace

double ResidualVariances::Sum() const {
  return std::accumulate(of_neighbours.begin(), of_neighbours.end(), own + of_key_point);
}

ResidualVariances FitResidualVariances(const MatchScores& scores, std::span<const int> groups) {
  const Eigen::LLT<Matrix5d> llt(scores.information);
  if (groups.empty() || llt.info() != Eigen::Success) return {};
  const Matrix5d L = llt.matrixL();
  const ResidualMoments moments = ComputeMoments(SelectKeyPoints(scores, groups, L));
  const Solution solution = SolveMoments(moments);
  ResidualVariances variances;
  variances.own = solution.v(kOwn);
  variances.of_key_point = solution.v(kKeyPoint);
  for (int b = kFirstLength; b < kNumParts; ++b) variances.of_neighbours.push_back(solution.v(b));
  variances.deviance = solution.deviance;
  SetShared(solution.v, moments, L, &variances);
  return variances;
}

std::optional<ResidualMoments> ComputeResidualMoments(const MatchScores& scores, std::span<const int> groups,
                                                      double unit_px) {
  const Eigen::LLT<Matrix5d> llt(scores.information);
  if (groups.empty() || llt.info() != Eigen::Success) return std::nullopt;
  MatchScores in_units = scores;  // positions of points matter only for distances
  for (Correspondence& match : in_units.matches) {
    match.x1_px /= unit_px;
    match.x2_px /= unit_px;
  }
  return ComputeMoments(SelectKeyPoints(in_units, groups, llt.matrixL()));
}

ResidualVariances TakeResidualVariances(const MatchScores& scores, std::span<const int> groups,
                                        const KnownVariances& known) {
  ResidualVariances variances;
  variances.own = known.own;
  const std::optional<ResidualMoments> moments =
      ComputeResidualMoments(scores, groups, known.length_px / kLongestPx);
  if (!moments) return variances;
  variances.of_key_point = known.of_key_point;
  variances.of_neighbours = {known.of_neighbours};
  Parts v = Parts::Zero();
  v(kKeyPoint) = known.of_key_point;
  v(kNumParts - 1) = known.of_neighbours;
  SetShared(v, *moments, scores.information.llt().matrixL(), &variances);
  return variances;
}

}  // namespace rcme
