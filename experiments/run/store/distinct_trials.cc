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

void RequireDistinct(ResultStore* a, ResultStore* b) {
  const RunDescription of_a = a->Description(), of_b = b->Description();
  if (of_a.identity != of_b.identity) return;
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
