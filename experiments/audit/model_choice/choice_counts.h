// How often each criterion of model choice gives which verdict, by the true kind of the problem: a confusion
// matrix per criterion.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/audit/model_choice/true_kind.h"
#include "experiments/core/work/runner.h"
#include "experiments/study/study_plan.h"

namespace rcme {

// Verdicts in the order of kSceneVerdicts; the last column counts trials without one.
inline constexpr size_t kNumAnswers = kSceneVerdicts.size() + 1;
// "general", ..., "no_verdict".
const std::string& AnswerName(size_t answer);

// Trials of one criterion: [truth][answer].
using ConfusionMatrix = std::array<std::array<std::int64_t, kNumAnswers>, kTrueKinds.size()>;

// Conditions with the same levels of the chosen factors, counted together: one matrix per criterion, in the
// order of CriterionNames().
struct ChoiceGroup {
  std::vector<std::string> levels;  // of the chosen factors
  std::vector<ConfusionMatrix> matrices;
};

struct ChoiceCounts {
  std::vector<std::string> by;  // the chosen factors
  std::vector<ChoiceGroup> groups;
};

// Applies every criterion, with default options, to the same fits to the first `plan.study.trials` trials of
// each condition. The verdicts draw from the estimators' stream and do not see the truth; it is used only
// here. The groups are those of the factors `by`, in the order of the conditions; without factors there is
// one group.
//
// Throws as Runner::Get. Throws InputError if `by` names no factor; for a condition whose scenes are unknown
// (real pairs), whose trials have weights, or whose scenes repeat; and for conditions that share their
// scenes.
ChoiceCounts CountChoices(const StudyPlan& plan, const std::vector<std::string>& by, Runner* runner);

// The runner's work; an item is ten trials of a condition. Throws InputError for such a condition.
WorkPlan PlanChoices(const StudyPlan& plan);

}  // namespace rcme
