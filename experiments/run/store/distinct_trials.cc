#include "experiments/run/store/distinct_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

// The first trial of a condition that is missing in neither file.
std::optional<std::uint32_t> FindCommonTrial(ResultStore* a, ResultStore* b, std::uint32_t condition,
                                             std::uint32_t num_trials) {
  std::vector<bool> is_missing(num_trials, false);
  for (ResultStore* store : {a, b}) {
    for (const TrialRange& range : store->MissingTrials(condition, num_trials))
      std::fill(is_missing.begin() + range.first, is_missing.begin() + range.end, true);
  }
  const auto common = std::ranges::find(is_missing, false);
  if (common == is_missing.end()) return std::nullopt;
  return static_cast<std::uint32_t>(common - is_missing.begin());
}

// The part of a study that its problems depend on: from the seed to the estimators.
std::string ProblemsIn(const std::string& identity) {
  const size_t begin = identity.find("\nseed: "), end = identity.find("\nestimators:");
  return begin < end && end != std::string::npos ? identity.substr(begin, end - begin) : identity;
}

bool HaveCommonEstimator(const RunDescription& a, const RunDescription& b) {
  return std::ranges::any_of(a.estimators, [&](const DescribedEstimator& one) {
    return std::ranges::count(b.estimators, one.label, &DescribedEstimator::label) > 0;
  });
}

// Studies that differ in their name, description or other estimators have the same trials.
void RequireDistinct(ResultStore* a, ResultStore* b) {
  const RunDescription of_a = a->Description(), of_b = b->Description();
  if (ProblemsIn(of_a.identity) != ProblemsIn(of_b.identity) || !HaveCommonEstimator(of_a, of_b)) return;
  for (size_t c = 0; c < std::min(of_a.conditions.size(), of_b.conditions.size()); ++c) {
    const auto num_trials =
        static_cast<std::uint32_t>(std::min(of_a.conditions[c].num_trials, of_b.conditions[c].num_trials));
    const std::optional<std::uint32_t> trial =
        FindCommonTrial(a, b, static_cast<std::uint32_t>(c), num_trials);
    if (!trial) continue;
    throw InputError(fmt::format(
        "{}, {}: both hold trial {} of condition {}, which would count twice; give each trial once "
        "(`rcme merge` makes one file of both)",
        a->path(), b->path(), *trial, c));
  }
}

}  // namespace

void RequireDistinctTrials(std::span<const std::string> paths) {
  std::vector<ResultStore> stores;
  for (const std::string& path : paths) stores.push_back(ResultStore::OpenForReading(path));
  for (size_t i = 0; i < stores.size(); ++i)
    for (size_t k = 0; k < i; ++k) RequireDistinct(&stores[k], &stores[i]);
}

}  // namespace rcme
