// The probabilities of failure that go with an estimator's motions, beside what became of these.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "stats/forecast.h"

namespace rcme {

// Up to this probability a motion counts as sure.
inline constexpr double kSureBelow = 0.1;

// The probability that the estimator states; nothing for a refusal, where the truth is not known, or where it
// states none.
std::optional<double> StatedFailureProbability(const TrialRecord& record);
// Its Brier score, (P - y)^2 with y = 1 for a failure; nothing likewise.
std::optional<double> BrierOfStated(const TrialRecord& record, const FailureBounds& bounds);

enum class ForecastSource {
  kStated,
  // Of an estimator that states none: the share of the matches that it takes for inliers, made a probability
  // by isotonic regression of failure on it. That is fitted to half of the scenes (those of even number, over
  // all conditions) and used on the other half, and the other way round, so that no trial is judged by
  // itself. It knows the failure rate of this very run, which no estimator does.
  kInlierShare
};
std::string Name(ForecastSource source);  // "stated", "inlier_share"

// One estimator in one group of trials.
struct FailureForecasts {
  std::string estimator;  // label
  std::string group;      // a level of the factor; empty: all trials
  ForecastSource source = ForecastSource::kStated;
  // Whether a cluster is a draw of the population that the run's draws are a sample of; else it is a scene.
  bool is_of_population = false;
  std::vector<Forecast> forecasts;             // of its answers
  std::vector<std::int64_t> refused_clusters;  // one per refusal
  // Answers that have no probability: they are in none of the numbers.
  std::int64_t num_without = 0;
};

// Every estimator in every group, in the order of the run. A group is a level of the factor `by`; without one
// all trials are one. Weighted trials have no forecasts: counts of them say nothing. Holds some 50 bytes per
// trial and estimator. Throws InputError on a factor that the run does not have.
std::vector<FailureForecasts> CollectFailureForecasts(const ResultStore& store, const std::string& by = {});

// Adds those of another run: to the same estimator and group, or as new ones. No cluster of one run is one of
// the other. Throws InputError where the source of an estimator's probabilities differs between the runs, or
// what a cluster is.
void AddForecastsOfRun(std::vector<FailureForecasts> run, std::vector<FailureForecasts>* all);

}  // namespace rcme
