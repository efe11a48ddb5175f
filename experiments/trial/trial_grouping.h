// Groups trials that depend on each other. The groups follow from what counts as a new problem.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "experiments/study/study_plan.h"

namespace rcme {

// What counts as a new problem, and therefore as independent.
enum class NewProblem {
  kTrial,      // another trial of the same conditions, or another pair of the same real scenes
  kCondition,  // a trial of another condition of the population, or of another real scene
};

// Assigns trials to groups; trials of different groups are independent. Trials are in one group if they
// share a scene or a real pair (which each pass over a folder repeats) and, with kCondition, if they share a
// draw or a real scene. Throws InputError if conditions are to be new but share their scenes. The plan must
// outlive this object.
class TrialGrouping {
 public:
  TrialGrouping(const StudyPlan& plan, NewProblem new_problem);
  std::int64_t FindGroup(const Condition& condition, std::uint32_t trial) const;

 private:
  const StudyPlan& plan_;
  NewProblem new_problem_;
  std::map<std::string, std::int64_t> scenes_;
};

// Returns kCondition for a population and for several real scenes, otherwise kTrial.
NewProblem UsualNewProblem(const StudyPlan& plan);

// Returns whether the plan has pairs of real scenes; pairs of one scene share images.
bool HasRealScenes(const StudyPlan& plan);

}  // namespace rcme
