#include "stats/forecast.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

namespace rcme {
namespace {

ClusteredEstimate MeasureMeanScore(std::span<const Forecast> forecasts, double greatest,
                                   double (*score)(const Forecast&), double confidence) {
  CheckForecasts(forecasts);
  std::vector<double> scores;
  scores.reserve(forecasts.size());
  for (const Forecast& forecast : forecasts) scores.push_back(score(forecast));
  return MeasureBoundedClusteredMean(scores, {0.0, greatest}, ListClusters(forecasts), confidence);
}

}  // namespace

double ClippedProbability(double probability, double clip) {
  return std::clamp(probability, clip, 1.0 - clip);
}

void CheckForecasts(std::span<const Forecast> forecasts) {
  if (forecasts.empty()) throw std::invalid_argument("forecasts: there are none");
  for (const Forecast& forecast : forecasts) {
    if (!(forecast.probability >= 0.0 && forecast.probability <= 1.0))
      throw std::invalid_argument("forecasts: a probability is not in [0, 1]");
  }
}

std::vector<std::int64_t> ListClusters(std::span<const Forecast> forecasts) {
  std::vector<std::int64_t> clusters;
  clusters.reserve(forecasts.size());
  for (const Forecast& forecast : forecasts) clusters.push_back(forecast.cluster);
  return clusters;
}

double BrierScore(double probability, bool happened) {
  const double miss = probability - (happened ? 1.0 : 0.0);
  return miss * miss;
}

double LogScore(double probability, bool happened, double clip) {
  const double p = ClippedProbability(probability, clip);
  return happened ? -std::log(p) : -std::log1p(-p);
}

ClusteredEstimate MeasureShareHappened(std::span<const Forecast> forecasts, double confidence) {
  const ClusteredEstimate share = MeasureMeanScore(
      forecasts, 1.0, [](const Forecast& f) { return f.happened ? 1.0 : 0.0; }, confidence);
  if (share.num_clusters < share.n) return share;
  ClusteredEstimate of_single = share;
  of_single.interval =
      ExactBinomialInterval(std::llround(share.value * static_cast<double>(share.n)), share.n, confidence);
  return of_single;
}

ClusteredEstimate MeasureBrierScore(std::span<const Forecast> forecasts, double confidence) {
  return MeasureMeanScore(
      forecasts, 1.0, [](const Forecast& f) { return BrierScore(f.probability, f.happened); }, confidence);
}

ClusteredEstimate MeasureLogScore(std::span<const Forecast> forecasts, double confidence) {
  return MeasureMeanScore(
      forecasts, std::max(LogScore(0.0, true), LogScore(1.0, false)),
      [](const Forecast& f) { return LogScore(f.probability, f.happened); }, confidence);
}

std::vector<std::int64_t> NumberedClusters(std::span<const Forecast> forecasts) {
  std::unordered_map<std::int64_t, std::int64_t> numbers;
  std::vector<std::int64_t> clusters;
  clusters.reserve(forecasts.size());
  for (const Forecast& forecast : forecasts)
    clusters.push_back(numbers.try_emplace(forecast.cluster, std::ssize(numbers)).first->second);
  return clusters;
}

std::vector<bool> DrawOutcomes(std::span<const Forecast> forecasts, std::span<const std::int64_t> clusters,
                               RandomStream& rng) {
  std::vector<double> uniforms;  // of the clusters seen so far
  std::vector<bool> outcomes(forecasts.size());
  for (size_t i = 0; i < forecasts.size(); ++i) {
    const auto cluster = static_cast<size_t>(clusters[i]);
    if (cluster == uniforms.size()) uniforms.push_back(rng.Uniform());
    outcomes[i] = uniforms[cluster] < forecasts[i].probability;
  }
  return outcomes;
}

}  // namespace rcme
