#include "stats/reliability.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "stats/isotonic_regression.h"

namespace rcme {
namespace {

// The forecasts grouped by distinct probability, ascending, with replaceable outcomes.
class Groups {
 public:
  explicit Groups(std::span<const Forecast> forecasts) : group_(forecasts.size()) {
    CheckForecasts(forecasts);
    for (const Forecast& forecast : forecasts) probabilities_.push_back(forecast.probability);
    std::sort(probabilities_.begin(), probabilities_.end());
    probabilities_.erase(std::unique(probabilities_.begin(), probabilities_.end()), probabilities_.end());
    counts_.assign(probabilities_.size(), 0.0);
    for (size_t i = 0; i < forecasts.size(); ++i) {
      const auto place =
          std::lower_bound(probabilities_.begin(), probabilities_.end(), forecasts[i].probability);
      group_[i] = static_cast<size_t>(place - probabilities_.begin());
      counts_[group_[i]] += 1.0;
    }
    happened_.resize(probabilities_.size());
  }

  template <typename Happened>
  void SetOutcomes(Happened&& happened) {
    std::fill(happened_.begin(), happened_.end(), 0.0);
    for (size_t i = 0; i < group_.size(); ++i) happened_[group_[i]] += happened(i) ? 1.0 : 0.0;
    std::vector<double> shares = happened_;
    for (size_t g = 0; g < shares.size(); ++g) shares[g] /= counts_[g];
    recalibrated_ = PoolAdjacentViolators(shares, counts_);
  }

  const std::vector<double>& probabilities() const { return probabilities_; }
  const std::vector<double>& counts() const { return counts_; }
  const std::vector<double>& happened() const { return happened_; }
  const std::vector<double>& recalibrated() const { return recalibrated_; }
  IsotonicFit Curve() const { return {probabilities_, recalibrated_}; }

  BrierDecomposition Decompose() const {
    const double n = static_cast<double>(group_.size());
    const double share = std::accumulate(happened_.begin(), happened_.end(), 0.0) / n;
    double brier = 0.0, of_recalibrated = 0.0;
    for (size_t g = 0; g < probabilities_.size(); ++g) {
      brier += SumOfScores(g, probabilities_[g]) / n;
      of_recalibrated += SumOfScores(g, recalibrated_[g]) / n;
    }
    const double uncertainty = share * (1.0 - share);
    return {brier, brier - of_recalibrated, uncertainty - of_recalibrated, uncertainty};
  }

 private:
  double SumOfScores(size_t g, double probability) const {
    return happened_[g] * BrierScore(probability, true) +
           (counts_[g] - happened_[g]) * BrierScore(probability, false);
  }

  std::vector<size_t> group_;  // per forecast
  std::vector<double> probabilities_, counts_, happened_, recalibrated_;
};

Groups GroupsWithOutcomes(std::span<const Forecast> forecasts) {
  Groups groups(forecasts);
  groups.SetOutcomes([&](size_t i) { return forecasts[i].happened; });
  return groups;
}

// The central range of the samples (in any order): each end leaves out less than the tail.
ConsistencyPoint ComputeConsistencyPoint(double probability, std::vector<double> samples) {
  constexpr double kConfidence = 0.95;
  std::sort(samples.begin(), samples.end());
  const auto num_outside =
      static_cast<size_t>(0.5 * (1.0 - kConfidence) * static_cast<double>(samples.size() + 1));
  const size_t skipped = num_outside > 0 ? num_outside - 1 : 0;
  return {probability, samples[skipped], samples[samples.size() - 1 - skipped]};
}

}  // namespace

std::vector<ReliabilityStep> ReliabilityCurve(std::span<const Forecast> forecasts) {
  const Groups groups = GroupsWithOutcomes(forecasts);
  std::vector<ReliabilityStep> steps;
  for (size_t g = 0; g < groups.probabilities().size(); ++g) {
    const double probability = groups.probabilities()[g], recalibrated = groups.recalibrated()[g];
    if (steps.empty() || steps.back().recalibrated != recalibrated)
      steps.push_back({probability, probability, recalibrated});
    steps.back().last = probability;
    steps.back().n += std::llround(groups.counts()[g]);
    steps.back().num_happened += std::llround(groups.happened()[g]);
  }
  return steps;
}

BrierDecomposition DecomposeBrierScore(std::span<const Forecast> forecasts) {
  return GroupsWithOutcomes(forecasts).Decompose();
}

CalibrationCheck CheckCalibration(std::span<const Forecast> forecasts, std::span<const double> probabilities,
                                  int num_samples, RandomStream& rng) {
  if (num_samples < 1) throw std::invalid_argument("calibration: at least one sample is needed");
  Groups groups = GroupsWithOutcomes(forecasts);
  const double miscalibration = groups.Decompose().miscalibration;
  const std::vector<std::int64_t> clusters = NumberedClusters(forecasts);
  std::vector<double> at;
  for (const double p : probabilities) {
    if (p >= groups.probabilities().front() && p <= groups.probabilities().back()) at.push_back(p);
  }
  std::vector<std::vector<double>> curves(at.size());
  CalibrationCheck check;
  int num_as_great = 0;
  for (int sample = 0; sample < num_samples; ++sample) {
    const std::vector<bool> outcomes = DrawOutcomes(forecasts, clusters, rng);
    groups.SetOutcomes([&](size_t i) { return outcomes[i]; });
    const double of_sample = groups.Decompose().miscalibration;
    check.miscalibration_if_calibrated += of_sample / num_samples;
    num_as_great += of_sample >= miscalibration - 1e-12 ? 1 : 0;  // equal but for rounding
    const IsotonicFit curve = groups.Curve();
    for (size_t k = 0; k < at.size(); ++k) curves[k].push_back(curve.At(at[k]));
  }
  check.p_value = (1.0 + num_as_great) / (1.0 + num_samples);
  for (size_t k = 0; k < at.size(); ++k) check.band.push_back(ComputeConsistencyPoint(at[k], curves[k]));
  return check;
}

}  // namespace rcme
