// How good probabilities of failure and covariances are over conditions that are a sample of a population,
// before and after a correction of both: the report of scripts/fit_calibrated.
//   rcme_calibrated_measures < TRIALS > CSV
// A line of TRIALS has the number of the trial's condition, whether the answer failed (0 or 1), then before
// and after the probability that was stated and whether the 95 % region held the truth (0 or 1):
//   12 0 0.003 1 0.04 1
// CSV: quantity, before, after, with the intervals of stats/ for a population, its conditions drawn as a
// whole; "-" where fewer than five conditions have such an answer.
#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "stats/area_under_curve.h"
#include "stats/calibration_error.h"
#include "stats/constants.h"
#include "stats/population_mean.h"
#include "stats/population_rate.h"

namespace rcme {
namespace {

constexpr size_t kLeastConditions = 5;
constexpr double kUsable = 0.1, kSure = 0.01;  // greatest P of an answer
constexpr int kNumBins = 10;

struct Answer {
  Forecast forecast;  // of failure; its cluster is the condition
  bool is_covered = false;
};
using Answers = std::vector<Answer>;

std::string Cell(double value, const Interval& interval) {
  return fmt::format("\"{:.3f} [{:.3f}, {:.3f}]\"", value, interval.lower, interval.upper);
}

// Of the answers of at most this P.
template <typename Has>
std::string RateCell(const Answers& answers, double greatest_p, const Has& has) {
  std::map<std::int64_t, ConditionCount> of_condition;
  for (const Answer& answer : answers) {
    if (answer.forecast.probability > greatest_p) continue;
    ConditionCount& count = of_condition[answer.forecast.cluster];
    ++count.num_trials;
    count.num_events += has(answer);
  }
  if (of_condition.size() < kLeastConditions) return "-";
  std::vector<ConditionCount> counts;
  for (const auto& [condition, count] : of_condition) counts.push_back(count);
  const PopulationRate rate = MeasurePopulationRate(counts, ConditionWeights::kByTrials);
  return Cell(rate.value, rate.interval);
}

template <typename Number>
std::string MeanCell(const Answers& answers, const Number& number) {
  std::map<std::int64_t, Moments> of_condition;
  for (const Answer& answer : answers) of_condition[answer.forecast.cluster].Add(number(answer.forecast));
  if (of_condition.size() < kLeastConditions) return "-";
  std::vector<Moments> moments;
  for (const auto& [condition, numbers] : of_condition) moments.push_back(numbers);
  const PopulationMean mean = MeasurePopulationMean(moments, ConditionWeights::kByTrials);
  return Cell(mean.value, mean.interval);
}

std::string CalibrationErrorCell(const Answers& answers) {
  std::vector<Forecast> forecasts;
  for (const Answer& answer : answers) forecasts.push_back(answer.forecast);
  RandomStream rng({.seed = 1});
  const BootstrapOptions options{.chance_bias = ChanceBias::kUpwards};
  const BootstrapEstimate error =
      MeasurePopulationCalibrationError(forecasts, Binning::kEqualWidth, kNumBins, options, rng);
  return Cell(error.value, error.interval);
}

std::string AreaCell(const Answers& answers) {
  std::map<std::int64_t, ScoreCluster> of_condition;
  bool has_failed = false, has_succeeded = false;
  for (const Answer& answer : answers) {
    ScoreCluster& cluster = of_condition[answer.forecast.cluster];
    (answer.forecast.happened ? cluster.positives : cluster.negatives).push_back(answer.forecast.probability);
    (answer.forecast.happened ? has_failed : has_succeeded) = true;
  }
  if (!has_failed || !has_succeeded) return "-";
  std::vector<ScoreCluster> clusters;
  for (const auto& [condition, cluster] : of_condition) clusters.push_back(cluster);
  const AreaUnderCurve area = MeasureClusteredAreaUnderCurve(clusters);
  return Cell(area.value, area.interval);
}

bool HasFailed(const Answer& answer) { return answer.forecast.happened; }
bool IsCovered(const Answer& answer) { return answer.is_covered; }

void PrintMeasures(const Answers& before, const Answers& after) {
  const auto print = [&](const char* quantity, const auto& measure) {
    fmt::print("{},{},{}\n", quantity, measure(before), measure(after));
  };
  fmt::print("quantity,before,after\n");
  print("failed", [](const Answers& a) { return RateCell(a, 1.0, HasFailed); });
  print("stated", [](const Answers& a) {
    return MeanCell(a, [](const Forecast& forecast) { return forecast.probability; });
  });
  print("kept at P <= 0.1", [](const Answers& a) {
    return RateCell(a, 1.0, [](const Answer& answer) { return answer.forecast.probability <= kUsable; });
  });
  print("failed at P <= 0.1", [](const Answers& a) { return RateCell(a, kUsable, HasFailed); });
  print("covered at P <= 0.1", [](const Answers& a) { return RateCell(a, kUsable, IsCovered); });
  print("covered at P <= 0.01", [](const Answers& a) { return RateCell(a, kSure, IsCovered); });
  print("ECE", CalibrationErrorCell);
  print("AUC", AreaCell);
  print("Brier", [](const Answers& a) {
    return MeanCell(a, [](const Forecast& f) { return BrierScore(f.probability, f.happened); });
  });
}

int Run() {
  Answers before, after;
  std::int64_t condition = 0;
  bool has_failed = false, covered_before = false, covered_after = false;
  double p_before = 0.0, p_after = 0.0;
  while (std::cin >> condition >> has_failed >> p_before >> covered_before >> p_after >> covered_after) {
    before.push_back({{p_before, has_failed, condition}, covered_before});
    after.push_back({{p_after, has_failed, condition}, covered_after});
  }
  if (!std::cin.eof() || before.empty()) {
    fmt::print(stderr, "rcme_calibrated_measures: line {} is no trial\n", before.size() + 1);
    return 2;
  }
  PrintMeasures(before, after);
  return 0;
}

}  // namespace
}  // namespace rcme

int main() { return rcme::Run(); }
