#include "experiments/real/camera_noise/systematic_displacement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "stats/constants.h"
#include "stats/random.h"

namespace rcme {
namespace {

constexpr int kCellColumns = 6, kCellRows = 4,
              kNumUnknowns = 2 * kCellColumns * kCellRows;  // dx of all cells, then dy
constexpr int kNumSignDraws = 9999;
constexpr size_t kLeastPairsOfTest = 5;

using Unknowns = Eigen::Matrix<double, kNumUnknowns, 1>;
using UnknownsSquare = Eigen::Matrix<double, kNumUnknowns, kNumUnknowns>;

// The cells around a point, with their weights, which add up to one.
struct WeightedCell {
  int cell;
  double weight;
};
std::array<WeightedCell, 4> FindCells(int columns, int rows, const Camera& camera,
                                      const Eigen::Vector2d& x_px) {
  struct Along {
    int low, high;
    double share;  // of `high`
  };
  const auto along = [](double x, int length, int count) {
    const double place = std::clamp((x + 0.5) / length * count - 0.5, 0.0, count - 1.0);
    const int low = std::min(static_cast<int>(place), std::max(0, count - 2));
    return Along{low, std::min(low + 1, count - 1), place - low};
  };
  const Along a = along(x_px.x(), camera.width, columns), b = along(x_px.y(), camera.height, rows);
  return {{{b.low * columns + a.low, (1.0 - b.share) * (1.0 - a.share)},
           {b.low * columns + a.high, (1.0 - b.share) * a.share},
           {b.high * columns + a.low, b.share * (1.0 - a.share)},
           {b.high * columns + a.high, b.share * a.share}}};
}

Unknowns FindRow(const Camera& camera, const Correspondence& match, const Eigen::Vector4d& normal) {
  Unknowns row = Unknowns::Zero();
  const auto add = [&](const Eigen::Vector2d& x_px, const Eigen::Vector2d& along) {
    for (const auto& [cell, weight] : FindCells(kCellColumns, kCellRows, camera, x_px)) {
      row(cell) += weight * along.x();
      row(kCellColumns * kCellRows + cell) += weight * along.y();
    }
  };
  add(match.x1_px, normal.head<2>());
  add(match.x2_px, normal.tail<2>());
  return row;
}

struct CellScore {
  ImageNumbers images;
  Unknowns score = Unknowns::Zero();
  UnknownsSquare information = UnknownsSquare::Zero();
};

CellScore ScoreCells(const FittedPair& pair, const Camera& camera) {
  CellScore of{pair.images};
  Eigen::Matrix<double, kNumUnknowns, 5> mixed = Eigen::Matrix<double, kNumUnknowns, 5>::Zero();
  Vector5d of_motion = Vector5d::Zero();
  const MatchScores& scores = pair.scores;
  for (size_t i = 0; i < scores.residuals.size(); ++i) {
    // rows and residuals are over the match's own noise, normals are not
    const Unknowns row = FindRow(camera, scores.matches[i], scores.normals[i]) / pair.scales[i];
    of.score += row * scores.residuals[i];
    of.information.selfadjointView<Eigen::Lower>().rankUpdate(row);
    mixed += row * scores.rows[i].transpose();
    of_motion += scores.rows[i] * scores.residuals[i];
  }
  of.information = UnknownsSquare(of.information.selfadjointView<Eigen::Lower>());
  const Eigen::LLT<Matrix5d> llt(scores.information);
  of.score = (of.score - mixed * llt.solve(of_motion)) / pair.variance;
  of.information = (of.information - mixed * llt.solve(mixed.transpose())) / pair.variance;
  return of;
}

bool HaveCommonImage(const ImageNumbers& a, const ImageNumbers& b) {
  return a.image1 == b.image1 || a.image1 == b.image2 || a.image2 == b.image1 || a.image2 == b.image2;
}

// s_u' s_v of pairs without a common image, and zero of others.
Eigen::MatrixXd ComputeProducts(const std::vector<CellScore>& scores) {
  const auto n = std::ssize(scores);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index u = 0; u < n; ++u) {
    for (Eigen::Index v = 0; v < n; ++v) {
      const CellScore &a = scores[static_cast<size_t>(u)], &b = scores[static_cast<size_t>(v)];
      if (u != v && !HaveCommonImage(a.images, b.images)) products(u, v) = a.score.dot(b.score);
    }
  }
  return products;
}

double ComputeSignPValue(const Eigen::MatrixXd& products, std::uint64_t seed) {
  RandomStream rng = StreamFor({seed, 0, 0, 0}, StreamPurpose::kMonteCarlo);
  const double observed = products.sum();
  Eigen::VectorXd signs(products.rows());
  int num_as_great = 1;
  for (int draw = 0; draw < kNumSignDraws; ++draw) {
    for (double& sign : signs) sign = rng.IntegerBelow(2) == 0 ? 1.0 : -1.0;
    num_as_great += signs.dot(products * signs) >= observed;
  }
  return static_cast<double>(num_as_great) / (kNumSignDraws + 1);
}

// Sum of tr(A_u A_v) over pairs without a common image.
double ComputeTrace(const std::vector<CellScore>& scores) {
  double trace = 0.0;
  for (const CellScore& a : scores) {
    for (const CellScore& b : scores) {
      if (&a != &b && !HaveCommonImage(a.images, b.images))
        trace += a.information.cwiseProduct(b.information).sum();
    }
  }
  return trace;
}

Unknowns PredictCells(const std::vector<CellScore>& scores, double tau2) {
  Unknowns score = Unknowns::Zero();
  UnknownsSquare information = UnknownsSquare::Zero();
  double squares = 0.0, expected = 0.0;
  for (const CellScore& of : scores) {
    score += of.score;
    information += of.information;
    squares += of.score.squaredNorm() - tau2 * of.information.squaredNorm();
    expected += of.information.trace();
  }
  const double phi = std::max(1.0, squares / expected);
  information.diagonal().array() += phi / tau2;
  return information.llt().solve(score);
}

}  // namespace

DisplacementCells FitSystematicDisplacement(const std::vector<FittedPair>& pairs, const Camera& camera,
                                            std::uint64_t seed) {
  DisplacementCells cells;
  cells.p_value = kNaN;
  if (pairs.size() < kLeastPairsOfTest) return cells;
  std::vector<CellScore> scores;
  for (const FittedPair& pair : pairs) scores.push_back(ScoreCells(pair, camera));
  const Eigen::MatrixXd products = ComputeProducts(scores);
  const double trace = ComputeTrace(scores);
  if (!(trace > 0.0)) return cells;
  cells.p_value = ComputeSignPValue(products, seed);
  const double tau2 = products.sum() / trace;
  if (!(tau2 > 0.0)) return cells;
  const Unknowns theta = PredictCells(scores, tau2);
  cells.columns = kCellColumns;
  cells.rows = kCellRows;
  cells.rms_px = std::sqrt(tau2);
  cells.dx_px.assign(theta.data(), theta.data() + kCellColumns * kCellRows);
  cells.dy_px.assign(theta.data() + kCellColumns * kCellRows, theta.data() + kNumUnknowns);
  return cells;
}

Eigen::Vector2d DisplacementAt(const DisplacementCells& cells, const Camera& camera,
                               const Eigen::Vector2d& x_px) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  if (cells.columns == 0) return sum;
  for (const auto& [cell, weight] : FindCells(cells.columns, cells.rows, camera, x_px)) {
    sum.x() += weight * cells.dx_px[static_cast<size_t>(cell)];
    sum.y() += weight * cells.dy_px[static_cast<size_t>(cell)];
  }
  return sum;
}

}  // namespace rcme
