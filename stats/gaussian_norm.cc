#include "stats/gaussian_norm.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace rcme {
namespace {

constexpr double kLeastTail = 1e-300, kSameSums = 1e-13;
constexpr int kFewestPoints = 16, kMostPoints = 1 << 16;

Eigen::Vector3d SortEigenvalues(const Eigen::Vector3d& eigenvalues) {
  if (!eigenvalues.allFinite()) throw std::invalid_argument("an eigenvalue of the covariance is not finite");
  if (eigenvalues.minCoeff() < 0.0)
    throw std::invalid_argument("an eigenvalue of the covariance is negative");
  Eigen::Vector3d sorted = eigenvalues;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  return sorted;
}

// The mean of `f` over p in [0, pi/2] by the trapezoidal rule; f must continue evenly at both ends.
template <typename Function>
double MeanOverQuarterTurn(const Function& f) {
  double sum = 0.5 * (f(0.0) + f(0.5 * std::numbers::pi));
  for (int i = 1; i < kFewestPoints; ++i) sum += f(0.5 * std::numbers::pi * i / kFewestPoints);
  double mean = sum / kFewestPoints;
  for (int n = kFewestPoints; n < kMostPoints; n *= 2) {
    for (int i = 0; i < n; ++i) sum += f(0.5 * std::numbers::pi * (i + 0.5) / n);
    const double finer = sum / (2 * n);
    if (std::abs(finer - mean) <= kSameSums * finer) return finer;
    mean = finer;
  }
  return mean;
}

// erf(r sqrt(v / (2 l3))) / sqrt(v) for v >= 0, 1 for l3 = 0.
double GaussianShare(double r, double l3, double v) {
  if (l3 == 0.0) return 1.0;
  const double scale = r / std::sqrt(2.0 * l3);
  if (v * scale * scale < 1e-16) return 2.0 / std::sqrt(std::numbers::pi) * scale;
  return std::erf(scale * std::sqrt(v)) / std::sqrt(v);
}

// `l` is descending, and its first entry is 1.
double NormTail(const Eigen::Vector3d& l, double r) {
  if (r == 0.0) return 1.0;
  const double outside = l(2) > 0.0 ? std::erfc(r / std::sqrt(2.0 * l(2))) : 0.0;
  const double mean = MeanOverQuarterTurn([&](double p) {
    const double cosine = std::cos(p), s = l(1) + (1.0 - l(1)) * cosine * cosine;
    const double exponential = std::exp(-r * r / (2.0 * s));
    return exponential == 0.0 ? 0.0 : exponential * GaussianShare(r, l(2), std::max(0.0, 1.0 - l(2) / s));
  });
  return std::min(1.0, outside + mean);
}

// The r >= 0 with tail_at(r) = tail; tail_at falls from 1 to 0.
template <typename Function>
double SolveTail(const Function& tail_at, double tail) {
  const auto excess = [&](double r) {
    return std::log(std::max(tail_at(r), std::numeric_limits<double>::min())) - std::log(tail);
  };
  double greatest = 1.0;
  while (excess(greatest) > 0.0) greatest *= 2.0;
  std::uintmax_t most_steps = 100;
  const auto [lower, upper] = boost::math::tools::toms748_solve(
      excess, 0.0, greatest, boost::math::tools::eps_tolerance<double>(46), most_steps);
  return 0.5 * (lower + upper);
}

}  // namespace

double GaussianNormQuantile(const Eigen::Vector3d& eigenvalues, double tail) {
  return GaussianNormQuantile(eigenvalues, Eigen::Vector3d::Zero(), 0.0, tail);
}

double GaussianNormQuantile(const Eigen::Vector3d& eigenvalues, const Eigen::Vector3d& other, double weight,
                            double tail) {
  if (!(tail >= kLeastTail && tail < 1.0))
    throw std::invalid_argument("the probability of a greater length is not in [1e-300, 1)");
  const double unit = std::sqrt(std::max(weight < 1.0 ? SortEigenvalues(eigenvalues)(0) : 0.0,
                                         weight > 0.0 ? SortEigenvalues(other)(0) : 0.0));
  if (unit == 0.0) return 0.0;
  const auto tail_at = [&](double r) {
    return (weight < 1.0 ? (1.0 - weight) * GaussianNormTail(eigenvalues, unit * r) : 0.0) +
           (weight > 0.0 ? weight * GaussianNormTail(other, unit * r) : 0.0);
  };
  return unit * SolveTail(tail_at, tail);
}

double GaussianNormTail(const Eigen::Vector3d& eigenvalues, double r) {
  const Eigen::Vector3d sorted = SortEigenvalues(eigenvalues);
  if (sorted(0) == 0.0) return r > 0.0 ? 0.0 : 1.0;
  return NormTail(sorted / sorted(0), r / std::sqrt(sorted(0)));
}

}  // namespace rcme
