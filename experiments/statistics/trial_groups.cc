#include "experiments/statistics/trial_groups.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "experiments/statistics/scenes_of_run.h"
#include "experiments/study/population.h"
#include "experiments/trial/severity_columns.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr size_t kNumGroups = 5;

const SeverityColumn& FindSeverityColumn(const std::string& name) {
  std::vector<std::string> names;
  for (const SeverityColumn& column : kSeverityColumns) {
    if (column.name == name) return column;
    names.emplace_back(column.name);
  }
  throw InputError(fmt::format("--fifths-of: '{}' is not a quantity of the problem; allowed: {}", name,
                               fmt::join(names, ", ")));
}

// Returns the greatest values of the first four groups.
std::vector<double> Bounds(std::vector<double> values) {
  std::ranges::sort(values);
  std::vector<double> bounds;
  for (size_t group = 1; group < kNumGroups; ++group) {
    bounds.push_back(values[(group * values.size() - 1) / kNumGroups]);
  }
  return bounds;
}

}  // namespace

TrialGroups GroupByCondition(const RunDescription& run) {
  TrialGroups groups{.factor_names = run.factors,
                     .levels = {},
                     .group_of = [](const ProblemRecord& problem) { return size_t{problem.condition}; },
                     .is_in_order = true};
  for (const auto& condition : run.conditions) groups.levels.push_back(condition.levels);
  return groups;
}

TrialGroups GroupByDraw(const RunDescription& run) {
  if (run.factors.empty() || run.factors.front() != kDrawFactor)
    throw std::logic_error("the conditions are no draws");
  TrialGroups groups{{kDrawFactor}, {}, {}};
  std::map<std::string, size_t> number_of;  // by draw
  std::vector<size_t> of_condition;
  for (const DescribedCondition& condition : run.conditions) {
    const std::string& draw = condition.levels.front();
    const auto [found, is_new] = number_of.try_emplace(draw, groups.levels.size());
    if (is_new) groups.levels.push_back({draw});
    of_condition.push_back(found->second);
  }
  groups.group_of = [of_condition](const ProblemRecord& problem) { return of_condition[problem.condition]; };
  return groups;
}

std::vector<size_t> NumberDraws(const RunDescription& run) {
  const bool has_draws = !run.factors.empty() && run.factors.front() == kDrawFactor;
  const TrialGroups groups = has_draws ? GroupByDraw(run) : GroupByCondition(run);
  std::vector<size_t> draws;
  ProblemRecord any_of;
  for (; any_of.condition < run.conditions.size(); ++any_of.condition)
    draws.push_back(groups.group_of(any_of));
  return draws;
}

TrialGroups OneGroup() {
  return {{}, {{}}, [](const ProblemRecord&) { return size_t{0}; }};
}

TrialClusters::TrialClusters(const RunDescription& run)
    : repeats_per_scene_(static_cast<std::uint32_t>(run.repeats_per_scene)),
      conditions_apart_(HasCommonScenes(run) ? 0 : std::int64_t{1} << 32) {
  if (IsSampleOfPopulation(run.identity)) draws_ = GroupByDraw(run);
}

std::int64_t TrialClusters::Find(const ProblemRecord& problem) const {
  return draws_ ? static_cast<std::int64_t>(draws_->group_of(problem)) : FindScene(problem);
}

std::int64_t TrialClusters::FindScene(const ProblemRecord& problem) const {
  return problem.trial / repeats_per_scene_ + conditions_apart_ * problem.condition;
}

TrialGroups GroupByFifth(const ResultStore& store, const std::string& quantity) {
  const auto field = FindSeverityColumn(quantity).field;
  std::vector<double> values;
  bool is_unknown_of_some = false;
  store.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>&) {
    const double value = problem.severity.*field;
    if (std::isnan(value)) {
      is_unknown_of_some = true;
    } else {
      values.push_back(value);
    }
  });
  if (values.empty()) throw InputError("fifths-of: " + quantity + " is unknown of all trials of this run");
  const std::vector<double> bounds = Bounds(std::move(values));
  TrialGroups groups{{"fifth", quantity}, {{"1", fmt::format("up to {:.3g}", bounds[0])}}, {}};
  for (size_t i = 1; i < bounds.size(); ++i) {
    groups.levels.push_back(
        {std::to_string(i + 1), fmt::format("{:.3g} to {:.3g}", bounds[i - 1], bounds[i])});
  }
  groups.levels.push_back({std::to_string(kNumGroups), fmt::format("above {:.3g}", bounds.back())});
  if (is_unknown_of_some) groups.levels.push_back({"unknown", "unknown"});
  groups.group_of = [field, bounds](const ProblemRecord& problem) {
    const double value = problem.severity.*field;
    if (std::isnan(value)) return kNumGroups;
    return static_cast<size_t>(std::ranges::lower_bound(bounds, value) - bounds.begin());
  };
  return groups;
}

}  // namespace rcme
