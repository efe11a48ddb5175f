// The one accumulator of the summary, of a run that keeps its trials and of one that keeps counts
// (run_counts.h): what the summary needs of the trials of one condition, or of one group of trials, in memory
// that does not grow with them.
//
// The sums of counts have no rounding errors, so that neither the order of the trials nor how they are
// grouped changes a bit. Exact are rates with their intervals, medians with theirs (as they are of trials),
// means and standard errors (correctly rounded), scores; the bounds of a score's mean are of scores moved by
// at most 1e-10 (stats/exact_scores.h).
//
// Rows are read in one order; their means are sums in floating point, and the bounds of scores are those of
// the scores themselves. Rows alone give rates of weighted trials, of repeated scenes means and a split
// (scene_split.h), and how errors rank (error_ranking.h).
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "experiments/run/store/counts_tables.h"
#include "experiments/statistics/error_ranking.h"
#include "experiments/statistics/scene_split.h"
#include "experiments/statistics/scenes_of_run.h"
#include "experiments/statistics/summarize.h"
#include "stats/exact_moments.h"
#include "stats/exact_scores.h"
#include "stats/moments.h"
#include "stats/score_mean.h"
#include "stats/stream_median.h"
#include "stats/weighted_rate.h"

namespace rcme {

// By kind, and for means by what is summed up: counts or rows. A rate's events have the weight 1, unless
// their trials are weighted.
using QuantityCounts = std::variant<WeightedEvents, StreamMedian, ExactScores, ExactMoments, Moments>;

// Of rows.
struct RowScores {
  Moments moments;
  ScoreMean scores;
};

// Of one estimator, or of the problems.
struct QuantitySums {
  std::vector<QuantityCounts> counts;  // by TrialQuantities() or ProblemQuantities()
  std::vector<RowScores> scores;       // the same; only of rows
  std::vector<SceneMean> scene;        // the same, of the scene so far; only of rows with repeated scenes
  std::int64_t num_scenes = 0;
  bool is_weighted = false;
};

class SummaryCell {
 public:
  // Of counts: trials without weights, each of a scene of its own.
  explicit SummaryCell(size_t num_estimators);
  // Of rows: every scene counts once, as summarize.h says.
  SummaryCell(size_t num_estimators, int repeats_per_scene);

  // Of counts of a run that has its trials: rank errors as well; before the first trial.
  void RankErrors();

  // The trials of a scene one after the other, then EndScene; of counts without it, all trials are alike.
  void Add(const ProblemRecord& problem, const std::vector<TrialRecord>& records, const FailureBounds& bounds,
           bool is_first_of_scene = true);
  void EndScene();
  // Of counts.
  void Merge(const SummaryCell& other);

  std::int64_t num_trials() const { return num_trials_; }
  bool ranks_errors() const { return !rankings_.empty(); }
  const QuantitySums& of_estimator(size_t estimator) const { return estimators_[estimator]; }
  const QuantitySums& of_problems() const { return problems_; }
  // The rows of a summary; `cell` holds what they share but for the estimator.
  void AppendRows(const RunDescription& run, SummaryRow cell, std::vector<SummaryRow>* rows) const;

  // Of counts.
  std::vector<CountedQuantity> Texts() const;
  // Throws Damage for texts that it does not give, or not of so many trials.
  static SummaryCell FromTexts(const std::vector<CountedQuantity>& texts, size_t num_estimators,
                               std::int64_t num_trials);

 private:
  std::int64_t num_trials_ = 0;
  std::vector<QuantitySums> estimators_;
  QuantitySums problems_;
  std::vector<SceneSplit> splits_;      // by estimator; none without repeats
  std::vector<ErrorRanking> rankings_;  // by estimator; none of counts alone
};

// The summary of a run, of one group after the other.
class GroupSummarizer {
 public:
  GroupSummarizer(const RunDescription& run, const TrialGroups& groups);

  void Append(const SummaryCell& cell);  // of the next group
  Summary Finish(bool with_times);

 private:
  const RunDescription& run_;
  Summary summary_;
  std::uint32_t num_groups_ = 0;
};

Summary SummarizeCells(const RunDescription& run, const TrialGroups& groups,
                       const std::vector<const SummaryCell*>& cells, bool with_times);

}  // namespace rcme
