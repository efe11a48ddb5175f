#include "experiments/real/camera_noise/fault_posterior.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace rcme {
namespace {

constexpr int kNumSizes = 7;
constexpr double kLeastOfNominal = 3.0, kPriorOfNone = 0.5;

// One set of faults at one size.
struct FaultModel {
  unsigned set = 0;  // bit j: fault j is there
  double log_weight = 0.0;
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

double LogBinomial(int n, int k) {
  return std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
}

int CountFaults(unsigned set, int num_faults) {
  int count = 0;
  for (int j = 0; j < num_faults; ++j) count += static_cast<int>((set >> j) & 1U);
  return count;
}

// The prior standard deviations t at step `size`, 0 to kNumSizes - 1: for faults in the set; zero for others.
Eigen::VectorXd FindSizes(const FaultEvidence& evidence, unsigned set, int size) {
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(evidence.estimates.size());
  const double x = static_cast<double>(size) / (kNumSizes - 1);
  for (Eigen::Index j = 0; j < sizes.size(); ++j) {
    const double least = kLeastOfNominal * evidence.nominal(j);
    if ((set >> j) & 1U) sizes(j) = least * std::pow(std::max(1.0, evidence.greatest(j) / least), x);
  }
  return sizes;
}

// Log of the share that the sizes of a set have, in proportion to 1 / t^2: t as a multiple of the least, a
// geometric mean over its faults.
std::vector<double> ComputeLogShares(const FaultEvidence& evidence, unsigned set, int num_faults) {
  std::vector<double> shares;
  double sum = 0.0;
  for (int size = 0; size < kNumSizes; ++size) {
    const Eigen::VectorXd sizes = FindSizes(evidence, set, size);
    double log_multiple = 0.0;
    for (Eigen::Index j = 0; j < sizes.size(); ++j)
      if (sizes(j) > 0.0) log_multiple += std::log(sizes(j) / (kLeastOfNominal * evidence.nominal(j)));
    shares.push_back(-2.0 * log_multiple / num_faults);
    sum += std::exp(shares.back());
  }
  for (double& share : shares) share -= std::log(sum);
  return shares;
}

FaultModel FitModel(const FaultEvidence& evidence, unsigned set, const Eigen::VectorXd& sizes,
                    double log_prior) {
  const Eigen::MatrixXd T = sizes.cwiseAbs2().asDiagonal(), sum = evidence.covariance + T;
  const Eigen::LLT<Eigen::MatrixXd> llt(sum);
  const Eigen::VectorXd whitened = llt.matrixL().solve(evidence.estimates);
  const double log_det = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
  return {set, log_prior - 0.5 * (log_det + whitened.squaredNorm()), T * llt.solve(evidence.estimates),
          T - T * llt.solve(T)};
}

std::vector<FaultModel> FitModels(const FaultEvidence& evidence) {
  const auto k = static_cast<int>(evidence.estimates.size());
  std::vector<FaultModel> models;
  for (unsigned set = 0; set < (1U << k); ++set) {
    const int num_faults = CountFaults(set, k);
    if (num_faults == 0) {
      models.push_back(FitModel(evidence, set, Eigen::VectorXd::Zero(k), std::log(kPriorOfNone)));
      continue;
    }
    const double log_prior = std::log((1.0 - kPriorOfNone) / k) - LogBinomial(k, num_faults);
    const std::vector<double> shares = ComputeLogShares(evidence, set, num_faults);
    for (int size = 0; size < kNumSizes; ++size)
      models.push_back(FitModel(evidence, set, FindSizes(evidence, set, size),
                                log_prior + shares[static_cast<size_t>(size)]));
  }
  return models;
}

// Posterior weights of the models, in their order, with sum one.
std::vector<double> ComputeWeights(const std::vector<FaultModel>& models) {
  double greatest = -std::numeric_limits<double>::infinity();
  for (const FaultModel& model : models) greatest = std::max(greatest, model.log_weight);
  std::vector<double> weights;
  double sum = 0.0;
  for (const FaultModel& model : models) {
    weights.push_back(std::exp(model.log_weight - greatest));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

}  // namespace

FaultPosterior InferFaults(const FaultEvidence& evidence) {
  const Eigen::Index k = evidence.estimates.size();
  const std::vector<FaultModel> models = FitModels(evidence);
  const std::vector<double> weights = ComputeWeights(models);
  FaultPosterior posterior{std::vector<double>(static_cast<size_t>(k), 0.0), Eigen::VectorXd::Zero(k),
                           Eigen::MatrixXd::Zero(k, k)};
  for (size_t i = 0; i < models.size(); ++i) {
    posterior.mean += weights[i] * models[i].mean;
    posterior.covariance += weights[i] * (models[i].covariance + models[i].mean * models[i].mean.transpose());
    for (Eigen::Index j = 0; j < k; ++j)
      if ((models[i].set >> j) & 1U) posterior.probabilities[static_cast<size_t>(j)] += weights[i];
  }
  posterior.covariance -= posterior.mean * posterior.mean.transpose();
  return posterior;
}

Eigen::VectorXd ChooseRemoved(const FaultPosterior& posterior) {
  Eigen::VectorXd removed = posterior.mean;
  for (Eigen::Index j = 0; j < removed.size(); ++j)
    if (posterior.probabilities[static_cast<size_t>(j)] <= 0.5) removed(j) = 0.0;
  return removed;
}

Eigen::MatrixXd ComputeUncertainty(const FaultPosterior& posterior, const Eigen::VectorXd& removed) {
  const Eigen::VectorXd off = posterior.mean - removed;
  return posterior.covariance + off * off.transpose();
}

}  // namespace rcme
