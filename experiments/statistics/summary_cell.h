// The accumulator of the summary, for runs that keep trials and for runs that keep counts (run_counts.h). It
// holds what the summary needs of the trials of one condition or group, in memory that does not grow with
// them. There are two kinds of cells:
//
// A cell of counts has sums without rounding errors, so neither the order of the trials nor their grouping
// changes a bit. Rates, medians and their intervals equal those of trials; means and standard errors are
// correctly rounded; the bounds of a score's mean are those of scores moved by at most 1e-10
// (stats/exact_scores.h).
//
// A cell of rows gets the trials in one order; its means are floating-point sums, and the bounds of scores
// are those of the scores themselves. Only cells of rows support rates of weighted trials, means and a
// variance split for repeated scenes (scene_split.h), and the ranking of errors (error_ranking.h).
#pragma once

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

// The accumulator of a quantity. Its type depends on the kind of quantity and, for means, on the kind of
// cell. The events of a rate have weight 1 unless their trials are weighted.
using QuantityCounts = std::variant<WeightedEvents, StreamMedian, ExactScores, ExactMoments, Moments>;

// Scores in a cell of rows.
struct RowScores {
  Moments moments;
  ScoreMean scores;
};

// The quantities of one estimator, or of the problems.
struct QuantitySums {
  std::vector<QuantityCounts> counts;  // by TrialQuantities() or ProblemQuantities()
  std::vector<RowScores> scores;       // likewise; only in cells of rows
  std::vector<SceneMean> scene;  // likewise, of the current scene; only in cells of rows with repeated scenes
  std::int64_t num_scenes = 0;
  bool is_weighted = false;
};

class SummaryCell {
 public:
  // A cell of counts, for trials without weights, each with its own scene.
  explicit SummaryCell(size_t num_estimators);
  // A cell of rows, in which every scene counts once, as described in summarize.h.
  SummaryCell(size_t num_estimators, int repeats_per_scene);

  // Lets a cell of counts rank errors too, for a run that has its trials. Call it before the first trial.
  void RankErrors();

  // Adds a trial. In a cell of rows, the trials of a scene follow each other, then call EndScene. A cell of
  // counts needs no EndScene and treats all trials alike.
  void Add(const ProblemRecord& problem, const std::vector<TrialRecord>& records, const FailureBounds& bounds,
           bool is_first_of_scene = true);
  void EndScene();
  // For cells of counts.
  void Merge(const SummaryCell& other);

  std::int64_t num_trials() const { return num_trials_; }
  // Returns whether there are trials and none was simulated. For cells of counts.
  bool IsNotSimulated() const;
  bool ranks_errors() const { return !rankings_.empty(); }
  const QuantitySums& of_estimator(size_t estimator) const { return estimators_[estimator]; }
  const QuantitySums& of_problems() const { return problems_; }
  // Appends the rows of a summary. `cell` has the values common to all rows except the estimator.
  void AppendRows(const RunDescription& run, SummaryRow cell, std::vector<SummaryRow>* rows) const;

  // For cells of counts.
  std::vector<CountedQuantity> Texts() const;
  // Throws Damage for texts that Texts cannot have returned, or that do not match `num_trials`.
  static SummaryCell FromTexts(const std::vector<CountedQuantity>& texts, size_t num_estimators,
                               std::int64_t num_trials);

 private:
  std::int64_t num_trials_ = 0;
  std::vector<QuantitySums> estimators_;
  QuantitySums problems_;
  std::vector<SceneSplit> splits_;      // by estimator; empty without repeats
  std::vector<ErrorRanking> rankings_;  // by estimator; empty for plain cells of counts
};

// Makes the summary of a run from its groups, one after the other.
class GroupSummarizer {
 public:
  GroupSummarizer(const RunDescription& run, const TrialGroups& groups);

  void Append(const SummaryCell& cell);  // the cell of the next group
  Summary Finish(bool with_times);

 private:
  const RunDescription& run_;
  Summary summary_;
  std::uint32_t num_groups_ = 0;
};

Summary SummarizeCells(const RunDescription& run, const TrialGroups& groups,
                       const std::vector<const SummaryCell*>& cells, bool with_times);

}  // namespace rcme
