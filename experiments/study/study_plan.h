#pragma once

#include <memory>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/study/study.h"

namespace rcme {

// A combination of levels, ready to simulate.
struct Condition {
  std::uint32_t index = 0;
  std::vector<std::string> levels;  // one per factor of the plan
  std::shared_ptr<const DataSource> source;
  int num_trials = 0;
  std::uint64_t stream_key = 0;  // names its random streams: a hash of its content, independent of the index
  // The plan's estimators with the options that are levels of this condition; empty: the plan's own.
  std::vector<std::shared_ptr<const MotionEstimator>> estimators = {};
};

// A study ready to run: conditions in a fixed order (first factor slowest) and estimators.
struct StudyPlan {
  Study study;
  std::vector<std::string> factor_names;
  std::vector<Condition> conditions;
  std::vector<RefusedDraw> refused;                                // draws that violate a restriction
  std::vector<std::shared_ptr<const MotionEstimator>> estimators;  // as study.estimators, or empty
  std::string study_yaml;                                          // the study in full (study_file.h)
  std::string identity;  // two runs may share a result file if their identities are equal
  // The text of the lock file (study_lock.h), empty: none; and the reason for departing from it.
  std::string lock, despite_lock;

  std::int64_t NumTrials() const;
};

// Returns the estimators for the trials of a condition.
const std::vector<std::shared_ptr<const MotionEstimator>>& FindEstimators(const StudyPlan& plan,
                                                                          const Condition& condition);

// Names the random streams of a trial; their purpose is set by the data (data_source.h).
StreamName NameOfTrial(const StudyPlan& plan, const Condition& condition, std::uint32_t trial);

// Names the streams of a trial's scene, noise and outliers, which the repeats of a scene share
// (Study::repeats_per_scene).
StreamName NameOfScene(const StudyPlan& plan, const Condition& condition, std::uint32_t trial);

// Whether the plan needs its estimators.
enum class PlanEstimators {
  kMade,
  kNotMade,  // only the problems are needed, so commands of files need no permission
};

// Makes the plan of a study. Throws InputError for impossible settings, an unreadable folder, more than
// 100,000 conditions, a command that has not been allowed (command_permission.h), or a population none of
// whose draws meets its restrictions. Whether the trials of a draw can be simulated is only known when they
// are made.
StudyPlan MakePlan(const Study& study, PlanEstimators estimators = PlanEstimators::kMade);
// The same for the study of a file; error messages name the file.
StudyPlan MakePlan(const Study& study, const std::string& path,
                   PlanEstimators estimators = PlanEstimators::kMade);
// Makes the plan of a single condition, with index 0 and the given levels (one per factor of the study's
// whole plan). Nothing is made for the other conditions, and the plan has no identity.
StudyPlan MakeConditionPlan(const Study& study, const std::vector<std::string>& levels);

}  // namespace rcme
