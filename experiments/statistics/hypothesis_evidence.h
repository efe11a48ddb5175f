// What the trials of a run say of its hypotheses, read once.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "experiments/statistics/scenes_of_run.h"
#include "experiments/statistics/summary_quantities.h"
#include "experiments/study/stated_hypothesis.h"
#include "stats/intervals.h"
#include "stats/paired.h"
#include "stats/population_mean.h"
#include "stats/population_rate.h"
#include "stats/score_mean.h"

namespace rcme {

struct MeasuredHypothesis {
  double value = 0.0;  // of the quantity, or of the difference; NaN without trials
  Interval interval;
  std::int64_t n = 0;  // trials; of repeated scenes: scenes
};

// Of one hypothesis, growing trial by trial.
class HypothesisEvidence {
 public:
  HypothesisEvidence(const RunDescription& run, const StatedHypothesis& stated);

  bool HasEstimators() const { return estimator_ && (against_ || !is_paired_); }
  bool HasCondition(size_t condition) const { return has_[condition]; }
  std::int64_t CountConditions() const;

  void Add(std::uint32_t condition, const std::vector<TrialRecord>& records);
  void EndScene(std::uint32_t condition);

  MeasuredHypothesis Measure(bool is_of_population, double confidence) const;

 private:
  struct Cluster {
    ConditionCount count;
    ConditionPair pair;
    Moments moments;
  };

  template <typename Field>
  std::vector<Field> Clusters(Field Cluster::*field) const;
  MeasuredHypothesis MeasureForPopulation(double confidence) const;
  MeasuredHypothesis MeasureForConditions(double confidence) const;

  const TrialQuantity& quantity_;
  std::optional<size_t> estimator_, against_;
  bool is_paired_, is_of_means_;
  FailureBounds bounds_;
  std::vector<bool> has_;  // by condition
  std::vector<size_t> cluster_of_;
  std::vector<Cluster> clusters_;
  PairedCounts pairs_;
  SceneMean scene_;
  ScoreMean scores_;
};

// How many trials of each condition were asked for beforehand: `trials` of each, but no more than have a
// number, so that their sum is an integer whatever a file says.
std::vector<std::int64_t> CountTrialsBefore(const RunDescription& run, int trials);

struct EvidenceTrials {
  std::vector<std::int64_t> num_trials;  // by condition, of those asked for beforehand
  bool is_weighted = false;
};
// Reads the run once: the first `before` trials of each condition, no others.
EvidenceTrials ReadEvidence(const ResultStore& store, const RunDescription& run,
                            const std::vector<std::int64_t>& before,
                            std::vector<HypothesisEvidence>* evidence);

}  // namespace rcme
