// The level of a setting at which a rate of an estimator crosses a value (stats/level_crossing.h), in each
// condition of a study and for each of its estimators.
#pragma once

#include <string>
#include <vector>

#include "experiments/core/work/kept_steps.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_event.h"
#include "stats/level_crossing.h"

namespace rcme {

struct CrossingQuestion {
  std::string setting;  // what `--set` may name: of the data, a failure bound, or an option of estimators
  double from = 0.0, to = 1;  // where to look, from < to, in its units
  bool is_logarithmic = false;
  bool is_falling = false;  // the rate falls with the setting
  TrialEvent event = TrialEvents().front();
  double rate = 0.01;
  std::int64_t num_trials = 10'000;  // for each estimator in each condition
};

struct RateCrossing {
  std::vector<std::string> levels;  // of the condition, one per factor of CrossingAnswer
  std::string estimator;            // its label
  // In units of the setting, ascending; ends are infinite where the crossing may lie beyond the range.
  double estimate = 0.0;
  Interval interval, logistic_interval;
  std::vector<EventsAtLevel> searched, fresh;
  std::int64_t num_trials() const;  // that could be simulated
};

struct CrossingAnswer {
  std::vector<std::string> factors;  // without the setting
  std::vector<RateCrossing> crossings;
};

// Steps: batches of trials at one level.
WorkPlan PlanCrossings(const Study& study, const CrossingQuestion& question);

// A pure function of study and question. Every level has scenes of its own, whatever `common_scenes` says:
// the intervals need independent trials. Trials of one level are the same for all estimators. Throws
// InputError for a setting that the study does not have or that is no number, for real pairs, for weighted
// trials, for scenes that are repeated, and where the event needs a truth that is not known; Stopped.
CrossingAnswer FindCrossings(const Study& study, const CrossingQuestion& question, int num_threads,
                             KeptSteps* steps);

}  // namespace rcme
