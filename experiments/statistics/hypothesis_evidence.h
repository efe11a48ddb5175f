// Measures the stated hypotheses of a run in one pass over its trials.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "experiments/statistics/scenes_of_run.h"
#include "experiments/statistics/stated_sharpness.h"
#include "experiments/statistics/summary_quantities.h"
#include "experiments/study/stated_hypothesis.h"
#include "stats/intervals.h"
#include "stats/paired.h"
#include "stats/population_rate.h"
#include "stats/score_mean.h"

namespace rcme {

struct MeasuredHypothesis {
  double value = 0.0;  // of the quantity or of the difference; NaN without trials
  Interval interval;
  std::int64_t n = 0;  // trials; scenes if scenes are repeated
};

// The data for one hypothesis, collected trial by trial.
class HypothesisEvidence {
 public:
  HypothesisEvidence(const RunDescription& run, const StatedHypothesis& stated);

  bool HasEstimators() const { return estimator_ && (against_ || !is_paired_); }
  bool HasCondition(size_t condition) const { return has_[condition]; }
  std::int64_t CountConditions() const;

  // Trials come scene by scene (scenes_of_run.h).
  void Add(const ProblemRecord& problem, const std::vector<TrialRecord>& records);
  void EndScene();

  MeasuredHypothesis Measure(bool is_of_population, double confidence) const;
  // Of the answers that are measured, if the quantity is a coverage; else unknown. kAgainst: of the other
  // estimator, of the same trials.
  enum class Side { kEstimator, kAgainst };
  StatedSharpness MeasureSharpness(Side side) const;

 private:
  // Trials that depend on each other: those of a draw, or with common scenes of a scene in all conditions.
  struct Cluster {
    ConditionCount count;
    ConditionPair pair;
    std::vector<double> values;  // of the trials, or the means of repeated scenes
  };

  template <typename Field>
  std::vector<Field> Clusters(Field Cluster::*field) const;
  MeasuredHypothesis MeasureForPopulation(double confidence) const;
  MeasuredHypothesis MeasureForConditions(double confidence) const;
  // By betting on the sums of the clusters: valid also if all of them agree.
  MeasuredHypothesis MeasureByClusters(double confidence) const;

  const TrialQuantity& quantity_;
  std::optional<size_t> estimator_, against_;
  bool is_paired_, is_of_means_, shares_scenes_;
  int repeats_per_scene_;
  FailureBounds bounds_;
  std::vector<bool> has_;  // by condition
  std::vector<size_t> cluster_of_;
  std::map<size_t, Cluster> clusters_;
  size_t current_cluster_ = 0;
  PairedCounts pairs_;
  SharpnessMedians sharpness_, sharpness_against_;  // only of a coverage
  SceneMean scene_;
  ScoreMean scores_;
};

// Returns the number of trials of each condition that were planned beforehand: `trials` per condition, or
// per pair of a folder. It is limited to the possible trial numbers, so the sum cannot overflow whatever a
// file says.
std::vector<std::int64_t> CountTrialsBefore(const RunDescription& run, int trials);

struct EvidenceTrials {
  std::vector<std::int64_t> num_trials;  // by condition; only planned trials
  bool is_weighted = false;
};
// Reads the run once, but only the first `before` trials of each condition.
EvidenceTrials ReadEvidence(const ResultStore& store, const RunDescription& run,
                            const std::vector<std::int64_t>& before,
                            std::vector<HypothesisEvidence>* evidence);

}  // namespace rcme
