#include "experiments/integrity/integrity_work.h"

#include <fmt/format.h>

#include "experiments/trial/trial_grouping.h"
#include "experiments/trial/trial_items.h"

namespace rcme {
namespace {

constexpr std::uint32_t kTrialsOfIntegrityItem = 100;

bool HasSharedScenes(const StudyPlan& plan) {
  return plan.study.repeats_per_scene > 1 || (plan.study.common_scenes && plan.conditions.size() > 1);
}

std::string ComputeCounts(const StudyPlan& plan, const IntegrityTerms& terms, const Condition& condition,
                          const TrialRange& trials) {
  IntegrityCounts counts;
  std::map<std::int64_t, IntegrityTally> scenes;
  for (std::uint32_t trial = trials.first; trial < trials.end; ++trial) {
    const IntegrityCounts one = CountTrial(RunTrialOfDraw(plan, condition, trial), terms);
    counts.Add(one);
    if (HasSharedScenes(plan))
      scenes[static_cast<std::int64_t>(trial) / plan.study.repeats_per_scene].Add(one.tally);
  }
  return IntegrityCountsAsText(counts, scenes);
}

}  // namespace

WorkPlan PlanIntegrity(const StudyPlan& plan, const IntegrityTerms& terms) {
  return PlanTrialItems(plan, "integrity", kTrialsOfIntegrityItem,
                        fmt::format("integrity 2: risk {}, alert limits {} and {} deg\n", terms.risk,
                                    terms.rotation_limit_deg, terms.direction_limit_deg));
}

void GetIntegrity(const StudyPlan& plan, const IntegrityTerms& terms, Runner* runner) {
  GetTrialItems(
      plan, kTrialsOfIntegrityItem,
      [&](const Condition& condition, const TrialRange& trials) {
        return ComputeCounts(plan, terms, condition, trials);
      },
      runner);
}

std::vector<ConditionIntegrity> ReadIntegrity(const StudyPlan& plan, const Runner& runner) {
  std::vector<ConditionIntegrity> conditions(plan.conditions.size());
  ReadResults(runner.plan(), runner.results(), 0, runner.plan().groups.size(),
              [&](const ItemPlace& place, const std::string& text) {
                const TrialRange trials = FindTrialsOfItem(plan, place, kTrialsOfIntegrityItem);
                conditions[place.group].counts.Add(
                    ReadIntegrityCounts(text, trials.end - trials.first, &conditions[place.group].scenes));
              });
  const TrialGrouping grouping(plan, UsualNewProblem(plan));
  for (size_t c = 0; c < conditions.size(); ++c) {
    conditions[c].levels = plan.conditions[c].levels;
    conditions[c].group = grouping.FindGroup(plan.conditions[c], 0);
  }
  return conditions;
}

}  // namespace rcme
