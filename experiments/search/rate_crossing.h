// Finds the level of a setting at which a rate of an estimator crosses a value (stats/level_crossing.h), for
// each condition of a study and each of its estimators.
#pragma once

#include <string>
#include <vector>

#include "experiments/core/work/kept_steps.h"
#include "experiments/trial/trial_event.h"
#include "stats/level_crossing.h"

namespace rcme {

struct CrossingQuestion {
  std::string setting;        // a name for `--set`: of the data, a failure bound, or an option of estimators
  double from = 0.0, to = 1;  // the range of the search, from < to, in the setting's units
  bool is_logarithmic = false;
  bool is_falling = false;  // whether the rate decreases with the setting
  TrialEvent event = TrialEvents().front();
  double rate = 0.01;
  std::int64_t num_trials = 10'000;  // per estimator and condition
};

struct RateCrossing {
  std::vector<std::string> levels;  // of the condition, one per factor of CrossingAnswer
  std::string estimator;            // its label
  // In units of the setting, ascending. An end is infinite if the crossing may lie beyond the range.
  double estimate = 0.0;
  Interval interval, logistic_interval;
  std::vector<EventsAtLevel> searched, fresh;
  std::int64_t num_refused = 0;     // trials that ended in a refusal and count as no event
  std::int64_t num_trials() const;  // trials that could be simulated
};

struct CrossingAnswer {
  std::vector<std::string> factors;  // without the setting
  std::vector<RateCrossing> crossings;
};

// Returns the study with only those of its estimators that the setting applies to: for an option, the ones
// that have it. Throws InputError if there is none.
Study KeepEstimatorsWithSetting(Study study, const CrossingQuestion& question);

// The work; its steps are batches of trials at one level.
WorkPlan PlanCrossings(const Study& study, const CrossingQuestion& question);

// A pure function of study and question. Every level has trials of its own, whatever the setting and even
// with `common_scenes`, because the intervals need independent trials. At one level, all estimators get the
// same trials.
//
// Throws InputError for a setting that the study does not have or that is not a number, for real pairs, for
// weighted trials, for repeated scenes, and if the event needs a truth that is unknown. Throws Stopped.
CrossingAnswer FindCrossings(const Study& study, const CrossingQuestion& question, int num_threads,
                             KeptSteps* steps);

}  // namespace rcme
