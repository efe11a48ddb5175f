// Collects the pairs of values of one estimator and the reference for one compared quantity, trial by trial.
#pragma once

#include <span>

#include "experiments/statistics/compare.h"
#include "experiments/statistics/scenes_of_run.h"
#include "stats/moments.h"
#include "stats/score_mean.h"
#include "stats/stream_median.h"

namespace rcme {

class ComparedPairs {
 public:
  ComparedPairs(ComparedKind kind, bool has_repeats) : kind_(kind), has_repeats_(has_repeats) {}

  void Add(double first, double second, bool is_first_of_scene);
  void EndScene();

  // Sets the numbers of a row.
  void Fill(bool is_anytime_valid, ComparisonRow* row) const;
  // The same for all draws of a population together, with intervals for the population
  // (stats/population_rate.h). The interval of an event is that of the difference of two rates, "only the
  // estimator" and "only the reference"; that of a score is Student's over draws; that of an error's median
  // is Woodruff's (population_median.h). The p-value is the least level at which the interval does not
  // contain 0; for an error this is the interval of the share of greater errors minus the share of smaller
  // ones.
  static void FillOfPopulation(std::span<const ComparedPairs> draws, ComparisonRow* row);

 private:
  bool IsByMeans() const {
    return kind_ == ComparedKind::kScore || (kind_ == ComparedKind::kEvent && has_repeats_);
  }
  double PValueOfCounts(bool is_anytime_valid) const;
  Interval AnytimeRiskDifferenceInterval() const;
  void FillEvent(ComparisonRow* row) const;
  void FillMeans(ComparisonRow* row) const;
  void FillError(ComparisonRow* row) const;
  void Merge(const ComparedPairs& other);

  ComparedKind kind_;
  bool has_repeats_;
  PairedCounts counts_;
  SceneMean scene_;                         // of the current scene
  ScoreMean mean_difference_{{-1.0, 1.0}};  // over the means of scenes
  Moments difference_;                      // over the means of scenes
  StreamMedian error_difference_;
};

}  // namespace rcme
