// Scores of a hypothesis by how well, not only how many, matches fit it. Each maps e^2 of all matches, the
// squared Sampson distances over sigma^2, to a cost; the smallest cost wins.
#pragma once

#include <cmath>
#include <numbers>
#include <span>

#include "estimator/thresholds.h"

namespace rcme {

// MSAC (Torr & Zisserman 2000, "MLESAC", section 4): sum rho(e^2), rho(e^2) = e^2 within the threshold T^2 of
// the inlier test, T^2 beyond it.
struct MsacScore {
  static double Cost(std::span<const double> squared_distances, const Thresholds& thresholds) {
    double cost = 0.0;
    for (const double e2 : squared_distances) cost += e2 <= thresholds.point ? e2 : thresholds.point;
    return cost;
  }
};

// MLESAC (the same paper, section 4): the negative log-likelihood of a mixture,
//
//   - sum ln( gamma phi(e) + (1 - gamma) / v ),   phi(e) = exp(-e^2 / 2) / sqrt(2 pi),
//
// with errors in units of sigma and v the range of the error of a wrong match, the diagonal of image 2.
// Expectation maximisation estimates the inlier share gamma for each hypothesis, starting at 1/2: the next
// gamma is the mean of the probabilities gamma phi / (gamma phi + (1 - gamma) / v).
struct MlesacScore {
  static constexpr int kNumSteps = 3;  // "two or three iterations"

  static double Cost(std::span<const double> squared_distances, const Thresholds& thresholds) {
    const double of_wrong = std::exp(-thresholds.outlier_cost);  // 1 / v
    double gamma = 0.5;
    for (int step = 0; step < kNumSteps; ++step) {
      double sum = 0.0;
      for (const double e2 : squared_distances) {
        const double right = gamma * Density(e2);
        sum += right / (right + (1.0 - gamma) * of_wrong);
      }
      gamma = sum / static_cast<double>(squared_distances.size());
    }
    double cost = 0.0;
    for (const double e2 : squared_distances) {
      cost -= std::log(gamma * Density(e2) + (1.0 - gamma) * of_wrong);
    }
    return cost;
  }

 private:
  static double Density(double e2) {
    return e2 < 1400.0 ? std::exp(-0.5 * e2) / std::sqrt(2.0 * std::numbers::pi) : 0.0;
  }
};

}  // namespace rcme
