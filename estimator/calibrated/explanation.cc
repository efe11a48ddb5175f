#include "estimator/calibrated/explanation.h"

#include <algorithm>
#include <cmath>

namespace rcme {

double NoiseDensity(const NoiseLaw& noise, double u) {
  const double inverse = 1.0 / (1.0 + u * u / noise.dof());
  double power = inverse;
  for (int i = 1; i < noise.power; ++i) power *= inverse;
  return noise.peak * power;
}

double NoiseWeight(const NoiseLaw& noise, double u) { return 2.0 * noise.power / (noise.dof() + u * u); }

namespace {

// Scatter of points in an image.
struct Scatter {
  double sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0, sum_yy = 0.0;

  void Add(double x, double y) {
    sum_x += x, sum_y += y;
    sum_xx += x * x, sum_xy += x * y, sum_yy += y * y;
  }
  double Determinant(double n) const {
    const double xx = sum_xx - sum_x * sum_x / n, xy = sum_xy - sum_x * sum_y / n,
                 yy = sum_yy - sum_y * sum_y / n;
    return std::max(xx * yy - xy * xy, 0.0) / (n * n);
  }
};

double ComputeExtent(const MatchBlocks& matches, const std::vector<double>& probability, int num_explained) {
  if (num_explained == 0) return 0.0;
  Scatter in_image1, in_image2;
  for (size_t i = 0; i < probability.size(); ++i) {
    if (!(probability[i] > 0.5)) continue;
    const MatchBlock& block = matches[static_cast<int>(i / kBlockSize)];
    const size_t lane = i % kBlockSize;
    in_image1.Add(block.x1[lane], block.y1[lane]);
    in_image2.Add(block.x2[lane], block.y2[lane]);
  }
  return std::pow(in_image1.Determinant(num_explained) * in_image2.Determinant(num_explained), 0.125);
}

}  // namespace

Explanation Explain(const MatchBlocks& matches, const Mode& mode) {
  const auto n = static_cast<size_t>(matches.num_matches());
  const MixtureParameters& m = mode.mixture;
  Explanation e;
  EvaluateTerms(matches, mode.pose, &e.terms);
  e.inlier_density.resize(n);
  e.probability.resize(n);
  e.leverage.assign(n, 0.0);
  e.left_out_density.resize(n);
  for (size_t i = 0; i < n && !matches.noise_scales().empty(); ++i)
    e.noise_scale.push_back(matches.NoiseScaleAt(i));
  for (size_t i = 0; i < n; ++i) {
    const double u = e.terms.residual[i] / m.scale;
    const double in_front = CheiralityFactor(e.terms.depth[i] / m.scale) / m.scale;
    e.inlier_density[i] = NoiseDensity(m.noise, u) * in_front;
    const double inlier = m.inlier_ratio * e.inlier_density[i];
    const double outlier = WrongDensity(e, i, (1.0 - m.inlier_ratio) * m.outlier_density);
    e.probability[i] = inlier / (inlier + outlier);
    e.num_explained += e.probability[i] > 0.5;
    e.left_out_density[i] = e.inlier_density[i];
    if (e.probability[i] < 1e-3) continue;
    const bool is_used = mode.used[i / kBlockSize] >> (i % kBlockSize) & 1;
    Vector5d J;
    for (size_t k = 0; k < 5; ++k) J(static_cast<Eigen::Index>(k)) = e.terms.derivative[k][i];
    const double information = e.probability[i] * NoiseWeight(m.noise, u) / (m.scale * m.scale);
    const double a = information * J.dot(mode.inverse_hessian * J);
    // A match that the fit does not use has the leverage that it would have if it were used.
    const double h = e.leverage[i] = is_used ? std::min(a, 1.0) : a / (1.0 + a);
    const double left = std::sqrt(std::max(1.0 - h, 1e-4));
    e.left_out_density[i] = NoiseDensity(m.noise, is_used ? u / left : u * left) * left * in_front;
  }
  e.extent = ComputeExtent(matches, e.probability, e.num_explained);
  return e;
}

}  // namespace rcme
