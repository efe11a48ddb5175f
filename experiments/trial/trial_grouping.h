// Which trials depend on each other, and what a new problem is.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "experiments/study/study_plan.h"

namespace rcme {

// What a new problem is, and so what is independent.
enum class NewProblem {
  kTrial,      // another trial of these conditions, or another pair of these real scenes
  kCondition,  // a trial of another condition: drawn as these were, or of another real scene
};

// The group of a trial: trials of different groups are independent. Of one group are at least the trials of
// one scene, of one real pair (it comes again in each pass over a folder), and, where conditions are new, of
// one draw or real scene. The plan outlives it. Throws InputError where conditions share their scenes and are
// to be new.
class TrialGrouping {
 public:
  TrialGrouping(const StudyPlan& plan, NewProblem new_problem);
  std::int64_t FindGroup(const Condition& condition, std::uint32_t trial) const;

 private:
  const StudyPlan& plan_;
  NewProblem new_problem_;
  std::map<std::string, std::int64_t> scenes_;
};

// Of a population of conditions, and of several real scenes: another one; otherwise another trial.
NewProblem UsualNewProblem(const StudyPlan& plan);

// Whether pairs are of real scenes, whose images they share.
bool HasRealScenes(const StudyPlan& plan);

}  // namespace rcme
