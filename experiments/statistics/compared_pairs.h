// The pairs of one estimator and the reference, of one thing that is compared, growing trial by trial.
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

  // What a row says of them.
  void Fill(bool is_anytime_valid, ComparisonRow* row) const;
  // The same of all draws of a population together, with its intervals (stats/population_rate.h): those of an
  // event are of two rates, "only the estimator" and "only the reference", those of a score Student's over
  // draws, and those of an error's median Woodruff's (population_median.h). p is the least level at which the
  // interval, of an error that of the share greater less the share less, leaves out 0.
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
  SceneMean scene_;                         // so far
  ScoreMean mean_difference_{{-1.0, 1.0}};  // of the means of scenes
  Moments difference_;                      // the same
  StreamMedian error_difference_;
};

}  // namespace rcme
