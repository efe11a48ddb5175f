// Collects the failure probabilities of an estimator's motions, with their outcomes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "stats/forecast.h"

namespace rcme {

// A motion with at most this failure probability counts as sure.
inline constexpr double kSureBelow = 0.1;

// Returns the probability that the estimator states. Nothing for a refusal, an estimator that states none, or
// an unknown truth. That a motion is off in its rotation or in its direction cannot be judged if the true
// motion has no direction, as in a pure rotation.
std::optional<double> StatedFailureProbability(const TrialRecord& record);
// Returns its Brier score, (P - y)^2 with y = 1 for a failure; nothing in the same cases.
std::optional<double> BrierOfStated(const TrialRecord& record, const FailureBounds& bounds);

enum class ForecastSource {
  kStated,
  // For an estimator that states none: a probability made from the share of matches that it accepts as
  // inliers, by isotonic regression of failure. The regression fitted to even-numbered scenes of all
  // conditions is used for the odd-numbered ones and vice versa, so no trial is judged by itself. It knows
  // the failure rate of this run, which no estimator does.
  kInlierShare
};
std::string Name(ForecastSource source);  // "stated", "inlier_share"

// The forecasts of one estimator in one group of trials.
struct FailureForecasts {
  std::string estimator;  // label
  std::string group;      // a level of the factor; empty: all trials
  ForecastSource source = ForecastSource::kStated;
  // True: a cluster is a draw from the population of the run. False: it is a scene.
  bool is_of_population = false;
  std::vector<Forecast> forecasts;             // of its answers
  std::vector<std::int64_t> refused_clusters;  // one per refusal
  // Answers without a probability, or whose probability cannot be judged; no other number counts them.
  std::int64_t num_without = 0;
  // The scenes of the forecasts, which in a population are not their clusters. Numbers of different runs may
  // be equal.
  std::vector<std::int64_t> scenes = {};
};

// Returns the forecasts of every estimator in every group, in the order of the run. A group is a level of
// the factor `by`; without a factor all trials are one group. Uses about 50 bytes per trial and
// estimator. Throws InputError if the run does not have the factor, or if its trials are weighted: shares of
// them are no rates.
std::vector<FailureForecasts> CollectFailureForecasts(const ResultStore& store, const std::string& by = {});

// Adds the forecasts of another run, to the same estimator and group or as new ones. Clusters of different
// runs are different. Throws InputError if the runs differ in the source of an estimator's probabilities or
// in what a cluster is.
void AddForecastsOfRun(std::vector<FailureForecasts> run, std::vector<FailureForecasts>* all);

}  // namespace rcme
