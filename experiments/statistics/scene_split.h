// Divides the variance of an event (failure, refusal, either) into the part between scenes and the sampler's
// part within them, for runs with repeats per scene (stats/variance_split.h).
#pragma once

#include <vector>

#include "experiments/statistics/summarize.h"
#include "stats/variance_split.h"

namespace rcme {

// The split for one estimator in one condition, collected trial by trial.
class SceneSplit {
 public:
  explicit SceneSplit(int repeats_per_scene);

  void Add(const TrialRecord& record, const FailureBounds& bounds);
  // Ends a scene. Scenes with missing trials, or with some that are not scored, are left out.
  void EndScene();

  // `cell` has the values common to all rows.
  void AppendRows(const SummaryRow& cell, std::vector<SummaryRow>* rows) const;

 private:
  // The counts of one event.
  struct Counts {
    int num_trials = 0, num_events = 0;  // in the current scene
    RepeatedEvents scenes;
  };

  int repeats_per_scene_;
  std::vector<Counts> counts_;  // one per event of TrialEvents()
};

// Explains the rows, for `rcme list quantities`.
std::vector<QuantityHelp> SceneSplitQuantities();

}  // namespace rcme
