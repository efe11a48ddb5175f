#pragma once

#include <memory>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/study/study.h"

namespace rcme {

// One cell of the design.
struct Condition {
  std::uint32_t index = 0;
  std::vector<std::string> levels;  // one per factor of the plan
  std::shared_ptr<const DataSource> source;
  int num_trials = 0;
  std::uint64_t stream_key = 0;  // of its random streams: what the condition is, whatever its index
  // Those of the plan with the options that are levels of the condition; empty: the plan's own.
  std::vector<std::shared_ptr<const MotionEstimator>> estimators = {};
};

// A study made ready to run: its conditions in a fixed order (first factor slowest), its estimators built.
struct StudyPlan {
  Study study;
  std::vector<std::string> factor_names;
  std::vector<Condition> conditions;
  std::vector<RefusedDraw> refused;  // draws outside of what is given: no conditions
  std::vector<std::shared_ptr<const MotionEstimator>> estimators;  // as study.estimators, or none
  std::string study_yaml;                                          // the study in full (study_file.h)
  std::string identity;  // equal for two runs that may share a result file
  // The text of its lock file (study_lock.h), empty: none; and why the study departs from it.
  std::string lock, despite_lock;

  std::int64_t NumTrials() const;
};

// The estimators that a condition's trials ask.
const std::vector<std::shared_ptr<const MotionEstimator>>& FindEstimators(const StudyPlan& plan,
                                                                          const Condition& condition);

// Names the random streams of a trial, but for their purpose (data_source.h).
StreamName NameOfTrial(const StudyPlan& plan, const Condition& condition, std::uint32_t trial);

// The same of its scene, noise and outliers, which the repeats of a scene share (Study::repeats_per_scene).
StreamName NameOfScene(const StudyPlan& plan, const Condition& condition, std::uint32_t trial);

// Whether somebody will ask the estimators of a plan.
enum class PlanEstimators {
  kMade,
  kNotMade,  // only its problems are of interest: a command of a file needs no permission
};

// Throws InputError: impossible settings, an unreadable folder, more than 100,000 conditions, a command that
// nobody has allowed (command_permission.h), a population without a draw that meets what is given. Whether
// the trials of a draw can be simulated shows when they are made.
StudyPlan MakePlan(const Study& study, PlanEstimators estimators = PlanEstimators::kMade);
// The same for the study of a file, which the message then names.
StudyPlan MakePlan(const Study& study, const std::string& path,
                   PlanEstimators estimators = PlanEstimators::kMade);
// The plan of one condition alone, of number 0: that with these levels, one per factor of the study's whole
// plan. Nothing of the others is made, and the plan has no identity.
StudyPlan MakeConditionPlan(const Study& study, const std::vector<std::string>& levels);

}  // namespace rcme
