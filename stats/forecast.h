// Probabilities stated for events before their outcome was known.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/clustered_estimate.h"
#include "stats/random.h"

namespace rcme {

struct Forecast {
  double probability = 0.0;  // that the event happens
  bool happened = false;
  std::int64_t cluster = 0;  // forecasts of one cluster (a scene) may depend on each other
};

// Probabilities are moved into [1e-4, 1 - 1e-4] before a logarithm is taken, since that of 0 is infinite. A
// few thousand trials cannot resolve smaller ones; an event stated to be impossible then costs 9.2 nats.
inline constexpr double kProbabilityClip = 1e-4;
double ClippedProbability(double probability, double clip = kProbabilityClip);

// Throws std::invalid_argument if there are no forecasts or a probability is not in [0, 1].
void CheckForecasts(std::span<const Forecast> forecasts);

std::vector<std::int64_t> ListClusters(std::span<const Forecast> forecasts);

// Scores of a forecast; smaller is better. Both are proper: on average no other probability scores better
// than the true one. Brier (1950): (p - y)^2, in [0, 1]. Good's (1952) logarithmic score: -log of the
// probability of the actual outcome (nats), clipped as above.
double BrierScore(double probability, bool happened);
double LogScore(double probability, bool happened, double clip = kProbabilityClip);

// The share of events that happened, and the mean scores, of forecasts that pass CheckForecasts. The 95 %
// intervals are clustered and valid for any law (by betting, MeasureBoundedClusteredMean); that of the share
// is exact if each forecast is a cluster of its own.
ClusteredEstimate MeasureShareHappened(std::span<const Forecast> forecasts);
ClusteredEstimate MeasureBrierScore(std::span<const Forecast> forecasts);
ClusteredEstimate MeasureLogScore(std::span<const Forecast> forecasts);

// Random outcomes under correct probabilities: an event happens if the uniform number of its cluster is below
// its probability. A forecast alone in its cluster is thus independent of the others. Forecasts of one
// cluster are as strongly dependent as events of these probabilities can be (any sum of them has the greatest
// spread), so tests by such outcomes are conservative. `clusters` numbers the clusters in order of first
// appearance, from 0 (NumberedClusters).
std::vector<std::int64_t> NumberedClusters(std::span<const Forecast> forecasts);
std::vector<bool> DrawOutcomes(std::span<const Forecast> forecasts, std::span<const std::int64_t> clusters,
                               RandomStream& rng);

}  // namespace rcme
