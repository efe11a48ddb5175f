#include "estimator/calibrated/contrast.h"

#include <algorithm>
#include <cmath>

namespace rcme {
namespace {

constexpr int kShareSteps = 8;

// The maximum-likelihood share of inliers in `set`, by expectation-maximisation. The prior counts as half an
// inlier and half an outlier.
double ShareAmong(const std::vector<size_t>& set, const Explanation& mode, double background) {
  double share = 0.5;
  for (int step = 0; step < kShareSteps; ++step) {
    double right = 0.5;
    for (const size_t i : set) {
      const double inlier = share * mode.left_out_density[i];
      right += inlier / (inlier + (1.0 - share) * WrongDensity(mode, i, background));
    }
    share = right / (static_cast<double>(set.size()) + 1.0);
  }
  return share;
}

struct Moments {
  double sum = 0.0, sum_squares = 0.0;
  double count = 0.0;
  void Add(double x) {
    sum += x;
    sum_squares += x * x;
    count += 1.0;
  }
  // Sum of squares about the mean.
  double Scatter() const { return count > 0.0 ? std::max(sum_squares - sum * sum / count, 0.0) : 0.0; }
};

}  // namespace

Contrast CompareModes(const Explanation& a, const Explanation& b, double background) {
  Contrast contrast;
  std::vector<size_t> only_one;
  Moments shared;
  for (size_t i = 0; i < a.probability.size(); ++i) {
    const bool by_a = a.probability[i] > 0.5, by_b = b.probability[i] > 0.5;
    if (!by_a && !by_b) continue;
    const double ratio = std::log(a.left_out_density[i] / b.left_out_density[i]);
    contrast.num_better_a += by_a && ratio > 0.0;
    contrast.num_better_b += by_b && ratio < 0.0;
    contrast.num_clearly_a += by_a && ratio > kClearly;
    contrast.num_clearly_b += by_b && ratio < -kClearly;
    if (by_a && by_b) {
      shared.Add(ratio);
    } else {
      only_one.push_back(i);
    }
  }
  const double share_a = ShareAmong(only_one, a, background), share_b = ShareAmong(only_one, b, background);
  for (const size_t i : only_one) {
    const double wrong = WrongDensity(a, i, background);
    contrast.exclusive += std::log((share_a * a.left_out_density[i] + (1.0 - share_a) * wrong) /
                                   (share_b * b.left_out_density[i] + (1.0 - share_b) * wrong));
  }
  contrast.shared = shared.sum;
  contrast.shared_variance = shared.Scatter();
  return contrast;
}

}  // namespace rcme
