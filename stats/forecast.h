// Probabilities that were stated of events before these did or did not happen.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/clustered_estimate.h"
#include "stats/random.h"

namespace rcme {

struct Forecast {
  double probability = 0.0;  // that it happens
  bool happened = false;
  std::int64_t cluster = 0;  // forecasts of one cluster (a scene) may depend on each other, others do not
};

// Logarithms of 0 are infinite. Where one is taken, probabilities are moved into [1e-4, 1 - 1e-4] first: a
// few thousand trials cannot tell a smaller one from that, and one event that was called impossible costs 9.2
// nats.
inline constexpr double kProbabilityClip = 1e-4;
double ClippedProbability(double probability, double clip = kProbabilityClip);

// Throws std::invalid_argument if there are no forecasts or a probability is not in [0, 1].
void CheckForecasts(std::span<const Forecast> forecasts);

std::vector<std::int64_t> ListClusters(std::span<const Forecast> forecasts);

// Scores of a forecast, the less the better; both proper: nobody gains by stating another probability than
// the one believed in. Brier (1950): (p - y)^2, in [0, 1]. Good's (1952) logarithmic score: -log of the
// probability of what happened (nats), clipped as above.
double BrierScore(double probability, bool happened);
double LogScore(double probability, bool happened, double clip = kProbabilityClip);

// Of forecasts that CheckForecasts lets pass, with intervals by clusters that hold for any law (by betting,
// MeasureBoundedClusteredMean): the share whose event happened (exact where each is a cluster of its own),
// and the mean scores.
ClusteredEstimate MeasureShareHappened(std::span<const Forecast> forecasts, double confidence = 0.95);
ClusteredEstimate MeasureBrierScore(std::span<const Forecast> forecasts, double confidence = 0.95);
ClusteredEstimate MeasureLogScore(std::span<const Forecast> forecasts, double confidence = 0.95);

// Outcomes as they could have been if every probability were right: each happens where the uniform number of
// its cluster is below its probability. A forecast alone in its cluster is so independent of the others;
// several of one cluster depend on each other as strongly as events of these probabilities can (any sum of
// them has then the greatest spread), so that what is judged by such outcomes is judged with caution.
// `clusters` numbers them in order of their first appearance, from 0 (NumberedClusters).
std::vector<std::int64_t> NumberedClusters(std::span<const Forecast> forecasts);
std::vector<bool> DrawOutcomes(std::span<const Forecast> forecasts, std::span<const std::int64_t> clusters,
                               RandomStream& rng);

}  // namespace rcme
