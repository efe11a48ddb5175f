// How much of the variance of an event (failure, refusal, either) is between scenes and how much the
// sampler's within them, in runs with repeats per scene (stats/variance_split.h).
#pragma once

#include <string>
#include <vector>

#include "experiments/statistics/summarize.h"
#include "stats/variance_split.h"

namespace rcme {

// Of one estimator in one condition, growing trial by trial.
class SceneSplit {
 public:
  explicit SceneSplit(int repeats_per_scene);

  void Add(const TrialRecord& record, const FailureBounds& bounds);
  // Scenes with fewer trials than asked for, or with some that are not scored, are left out.
  void EndScene();

  // `cell` holds what the rows share.
  void AppendRows(const SummaryRow& cell, std::vector<SummaryRow>* rows) const;

 private:
  // Of one event.
  struct Counts {
    int num_trials = 0, num_events = 0;  // in the scene so far
    RepeatedEvents scenes;
  };

  int repeats_per_scene_;
  std::vector<Counts> counts_;  // one per event of TrialEvents()
};

// What the rows are, for `rcme list quantities`.
std::vector<QuantityHelp> SceneSplitQuantities();

}  // namespace rcme
