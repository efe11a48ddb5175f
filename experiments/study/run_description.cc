#include "experiments/study/run_description.h"

#include <fmt/format.h>

#include <algorithm>

namespace rcme {
namespace {

DescribedEstimator Describe(const EstimatorSpec& spec) {
  DescribedEstimator estimator{spec.label, spec.name, DescribeEffort(spec), spec.options};
  std::ranges::sort(estimator.options);
  return estimator;
}

Settings ListAdempParts(const Study& study) {
  Settings parts;
  Ademp ademp = study.ademp.value_or(Ademp());
  for (const auto& [key, text] : Parts(ademp)) {
    if (!text->empty()) parts.emplace_back(key, *text);
  }
  return parts;
}

}  // namespace

std::int64_t RunDescription::NumTrials() const {
  std::int64_t sum = 0;
  for (const DescribedCondition& condition : conditions) sum += condition.num_trials;
  return sum;
}

RunDescription Describe(const StudyPlan& plan) {
  RunDescription run;
  run.study = plan.study.name;
  run.description = plan.study.description;
  run.ademp = ListAdempParts(plan.study);
  run.seed = plan.study.seed;
  run.trials = plan.study.trials;
  run.repeats_per_scene = plan.study.repeats_per_scene;
  run.failure = plan.study.failure;
  run.factors = plan.factor_names;
  for (const Condition& condition : plan.conditions)
    run.conditions.push_back({condition.levels, condition.num_trials});
  for (const EstimatorSpec& spec : plan.study.estimators) run.estimators.push_back(Describe(spec));
  run.study_yaml = plan.study_yaml;
  run.identity = plan.identity;
  run.lock = plan.lock;
  run.despite_lock = plan.despite_lock;
  return run;
}

Settings ListBounds(FailureBounds bounds) { return ListValues(Parameters(bounds)); }

bool IsTargetOpen(const RunDescription& run) {
  return run.stopping_rule == kUntilRule && run.until_trials == 0;
}

std::string DescribeProgress(std::int64_t num_done, std::int64_t num_planned, bool is_target_open) {
  if (!is_target_open) return fmt::format("{} of {} trials done", num_done, num_planned);
  return fmt::format(
      "{} trials done\nThe target of `rcme run --until` is not reached; the same command continues it.",
      num_done);
}

}  // namespace rcme
