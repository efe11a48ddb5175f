#include "experiments/study_plan.h"

#include <fmt/format.h>

#include "estimator/estimator_registry.h"
#include "experiments/study_file.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

// All combinations of the factors' levels, the first factor slowest.
std::vector<std::vector<std::string>> Combinations(const std::vector<Factor>& factors) {
  std::vector<std::vector<std::string>> rows = {{}};
  for (const Factor& factor : factors) {
    std::vector<std::vector<std::string>> longer;
    if (rows.size() * factor.levels.size() > kMaxConditions) {
      throw InputError(fmt::format("factors: more than {} combinations of levels", kMaxConditions));
    }
    for (const std::vector<std::string>& row : rows) {
      for (const std::string& level : factor.levels) {
        longer.push_back(row);
        longer.back().push_back(level);
      }
    }
    rows = std::move(longer);
  }
  return rows;
}

std::string Identity(const StudyPlan& plan) {
  Study same = plan.study;
  same.trials = 1;  // more trials extend a run
  same.description.clear();
  std::string identity = ToYaml(same);
  for (const Condition& condition : plan.conditions) {
    const std::string data = condition.source->Identity();
    if (!data.empty()) identity += fmt::format("# condition {}: {}\n", condition.index, data);
  }
  return identity;
}

}  // namespace

std::int64_t StudyPlan::NumTrials() const {
  std::int64_t sum = 0;
  for (const Condition& condition : conditions) sum += condition.num_trials;
  return sum;
}

StudyPlan MakePlan(const Study& study) {
  StudyPlan plan;
  plan.study = study;
  for (const Factor& factor : study.factors) plan.factor_names.push_back(factor.key);
  for (const std::vector<std::string>& levels : Combinations(study.factors)) {
    Settings settings = study.data;
    for (size_t f = 0; f < levels.size(); ++f) settings.emplace_back(study.factors[f].key, levels[f]);
    const DataSources made = MakeDataSources(settings);
    const bool is_first = plan.conditions.empty();
    if (is_first && !made.implied_factor.empty()) plan.factor_names.push_back(made.implied_factor);
    for (const auto& [level, source] : made.sources) {
      Condition condition{static_cast<std::uint32_t>(plan.conditions.size()), levels, source,
                          source->NumTrials(study.trials)};
      if (!made.implied_factor.empty()) condition.levels.push_back(level);
      plan.conditions.push_back(std::move(condition));
    }
  }
  for (const EstimatorSpec& spec : study.estimators) {
    plan.estimators.push_back(FindEstimator(spec.name).make(spec.options));
  }
  plan.study_yaml = ToYaml(study);
  plan.identity = Identity(plan);
  return plan;
}

}  // namespace rcme
