// The posterior of a camera's faults: against sums over a grid, and right on average over cameras of its own
// prior.
#include "experiments/real/camera_noise/fault_posterior.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <numbers>

#include "stats/random.h"

namespace rcme {
namespace {

constexpr int kNumSizes = 7;

FaultEvidence MakeEvidence(const Eigen::Vector2d& estimates, const Eigen::Matrix2d& covariance) {
  return {estimates, covariance, Eigen::Vector2d(0.002, 1.0), Eigen::Vector2d(0.5, 160.0)};
}

// Three times the nominal, to the greatest, in steps of equal ratio; the shares go with 1 / t^2.
struct Sizes {
  std::array<double, kNumSizes> first, second;
};
Sizes ListSizes() {
  Sizes sizes{};
  for (size_t i = 0; i < kNumSizes; ++i) {
    const double x = static_cast<double>(i) / (kNumSizes - 1);
    sizes.first[i] = 0.006 * std::pow(0.5 / 0.006, x);
    sizes.second[i] = 3.0 * std::pow(160.0 / 3.0, x);
  }
  return sizes;
}
std::array<double, kNumSizes> ComputeShares(const std::array<double, kNumSizes>& sizes) {
  std::array<double, kNumSizes> shares{};
  double sum = 0.0;
  for (const double t : sizes) sum += 1.0 / (t * t);
  for (size_t i = 0; i < kNumSizes; ++i) shares[i] = 1.0 / (sizes[i] * sizes[i] * sum);
  return shares;
}
// Of both faults together: in proportion to 1 over the product of both.
std::array<double, kNumSizes> ComputeSharesOfBoth(const Sizes& sizes) {
  std::array<double, kNumSizes> roots{};
  for (size_t i = 0; i < kNumSizes; ++i) roots[i] = std::sqrt(sizes.first[i] * sizes.second[i]);
  return ComputeShares(roots);
}

double NormalDensity(double x, double sd) {
  return std::exp(-0.5 * x * x / (sd * sd)) / (sd * std::sqrt(2.0 * std::numbers::pi));
}

// Prior of one fault alone, 1/8 of all, or of both, 1/4: 1/2 is shared by one and two faults.
double DensityAlone(double theta, const std::array<double, kNumSizes>& sizes) {
  const auto shares = ComputeShares(sizes);
  double density = 0.0;
  for (size_t i = 0; i < kNumSizes; ++i) density += 0.125 * shares[i] * NormalDensity(theta, sizes[i]);
  return density;
}
double DensityOfBoth(const Eigen::Vector2d& theta, const Sizes& sizes,
                     const std::array<double, kNumSizes>& shares) {
  double density = 0.0;
  for (size_t i = 0; i < kNumSizes; ++i)
    density +=
        0.25 * shares[i] * NormalDensity(theta(0), sizes.first[i]) * NormalDensity(theta(1), sizes.second[i]);
  return density;
}

TEST(InferFaults, IsTheSumOverAllFaults) {
  Eigen::Matrix2d covariance;
  covariance << 9e-6, -0.0018, -0.0018, 1.44;  // 0.3 %, 1.2 px, correlation -0.5
  const FaultEvidence evidence = MakeEvidence({0.006, 1.0}, covariance);
  const Sizes sizes = ListSizes();
  const auto shares_of_both = ComputeSharesOfBoth(sizes);
  const Eigen::Matrix2d precision = covariance.inverse();
  double sum = 0.0, first = 0.0, second = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  const auto add = [&](const Eigen::Vector2d& theta, double prior, bool has_first, bool has_second) {
    const Eigen::Vector2d off = evidence.estimates - theta;
    const double weight = prior * std::exp(-0.5 * off.dot(precision * off));
    sum += weight;
    first += has_first * weight;
    second += has_second * weight;
    mean += weight * theta;
    squares += weight * theta * theta.transpose();
  };
  const double step0 = 6e-5, step1 = 0.03;
  add({0.0, 0.0}, 0.5, false, false);
  for (int i = -200; i <= 400; ++i)
    add({i * step0, 0.0}, step0 * DensityAlone(i * step0, sizes.first), true, false);
  for (int j = -300; j <= 300; ++j)
    add({0.0, j * step1}, step1 * DensityAlone(j * step1, sizes.second), false, true);
  for (int i = -200; i <= 400; ++i) {
    for (int j = -300; j <= 300; ++j) {
      const Eigen::Vector2d theta(i * step0, j * step1);
      add(theta, step0 * step1 * DensityOfBoth(theta, sizes, shares_of_both), true, true);
    }
  }
  mean /= sum;
  const FaultPosterior posterior = InferFaults(evidence);
  EXPECT_NEAR(posterior.probabilities[0], first / sum, 1e-3);
  EXPECT_NEAR(posterior.probabilities[1], second / sum, 1e-3);
  EXPECT_NEAR(posterior.mean(0), mean(0), 1e-5);
  EXPECT_NEAR(posterior.mean(1), mean(1), 4e-3);
  const Eigen::Matrix2d spread = squares / sum - mean * mean.transpose();
  EXPECT_LT((posterior.covariance - spread).cwiseAbs().cwiseQuotient(covariance.cwiseAbs()).maxCoeff(), 4e-3);
}

TEST(InferFaults, LargeFaultsAreNotDrawnTowardsZero) {
  const Eigen::Matrix2d covariance = Eigen::Vector2d(6.25e-6, 1.0).asDiagonal();  // 0.25 %, 1 px
  const FaultPosterior posterior = InferFaults(MakeEvidence({0.2, 0.0}, covariance));
  const Eigen::VectorXd removed = ChooseRemoved(posterior);
  EXPECT_GT(posterior.probabilities[0], 0.9999);
  EXPECT_NEAR(removed(0), 0.2, 2.5e-4);
  EXPECT_EQ(removed(1), 0.0);
  const Eigen::MatrixXd uncertainty = ComputeUncertainty(posterior, removed);
  EXPECT_NEAR(std::sqrt(uncertainty(0, 0)), 2.5e-3, 1e-4);
}

// Pairs that tell nothing leave the prior: nothing to take out, and about four times the nominal.
TEST(InferFaults, WithoutEvidenceTheStatedCameraIsBelieved) {
  const Eigen::Matrix2d covariance = Eigen::Vector2d(1e4, 1e10).asDiagonal();
  const FaultPosterior posterior = InferFaults(MakeEvidence({-40.0, 3e4}, covariance));
  const Eigen::VectorXd removed = ChooseRemoved(posterior);
  EXPECT_EQ(removed, Eigen::Vector2d::Zero());
  const Eigen::MatrixXd uncertainty = ComputeUncertainty(posterior, removed);
  EXPECT_NEAR(std::sqrt(uncertainty(0, 0)) / 0.002, 4.3, 0.5);
  EXPECT_NEAR(std::sqrt(uncertainty(1, 1)) / 1.0, 4.3, 0.5);
}

// E[(theta - removed)' U^-1 (theta - removed)] = k whatever the evidence, over cameras of the prior.
TEST(ComputeUncertainty, IsRightOnAverage) {
  Eigen::Matrix2d covariance;
  covariance << 9e-6, -0.0018, -0.0018, 1.44;
  const Eigen::Matrix2d root = covariance.llt().matrixL();
  const Sizes sizes = ListSizes();
  RandomStream rng({.seed = 5, .purpose = 130});
  const auto draw = [&](const std::array<double, kNumSizes>& shares) {
    double u = rng.Uniform();
    size_t i = 0;
    while (i + 1 < kNumSizes && u >= shares[i]) u -= shares[i++];
    return i;
  };
  constexpr int kNumCameras = 4000;
  double sum = 0.0, squares = 0.0;
  for (int camera = 0; camera < kNumCameras; ++camera) {
    Eigen::Vector2d theta = Eigen::Vector2d::Zero();
    const double kind = rng.Uniform();
    if (kind < 0.125) {
      theta(0) = sizes.first[draw(ComputeShares(sizes.first))] * rng.Normal();
    } else if (kind < 0.25) {
      theta(1) = sizes.second[draw(ComputeShares(sizes.second))] * rng.Normal();
    } else if (kind < 0.5) {
      const size_t i = draw(ComputeSharesOfBoth(sizes));
      theta = Eigen::Vector2d(sizes.first[i] * rng.Normal(), sizes.second[i] * rng.Normal());
    }
    const Eigen::Vector2d noise = root * Eigen::Vector2d(rng.Normal(), rng.Normal());
    const FaultPosterior posterior = InferFaults(MakeEvidence(theta + noise, covariance));
    const Eigen::VectorXd removed = ChooseRemoved(posterior);
    const Eigen::Vector2d off = theta - removed;
    const double distance = off.dot(ComputeUncertainty(posterior, removed).ldlt().solve(off));
    sum += distance;
    squares += distance * distance;
  }
  const double mean = sum / kNumCameras, sd = std::sqrt(squares / kNumCameras - mean * mean);
  EXPECT_NEAR(mean, 2.0, 4.0 * sd / std::sqrt(kNumCameras));
  EXPECT_LT(4.0 * sd / std::sqrt(kNumCameras), 0.5);
}

}  // namespace
}  // namespace rcme
