#include "experiments/run/store/merge_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <set>

#include "experiments/core/work/progress.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/run/store/new_trials.h"
#include "experiments/run/store/places.h"
#include "experiments/trial/trial_columns.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

// Calls `visit` for every trial of a part, and checks each.
void ReadPart(const std::string& path, const std::string& identity,
              const std::function<void(const StoredTrial&)>& visit) {
  const std::unique_ptr<ResultFile> part = OpenPart(path);
  NamingFile(path, [&] {
    if (part->description.identity != identity) throw Damage("it has been replaced while it was read");
    if (part->description.keeps_counts)
      throw InputError(fmt::format("{}: holds counts, not trials (--keep counts)", path));
    part->ForEachTrial(std::nullopt, [&](const StoredTrial& trial) {
      if (IsStopRequested()) throw Stopped("stopped; nothing was written");
      visit(trial);
    });
  });
}

// The fields of a trial as text, without the time. Each record begins with the numbers of condition, trial
// and estimator.
Settings ListFields(const StoredTrial& trial) {
  Settings fields;
  const auto add = [&](const StoredColumn& column, const auto& field) {
    if (column.role != StoredColumn::Role::kTime) fields.emplace_back(column.name, FormatField(field));
  };
  VisitColumns(trial.problem, add);
  for (const TrialRecord& record : trial.records) VisitColumns(record, add);
  return fields;
}

void CheckEqual(const std::string& path, const StoredTrial& here, const StoredTrial& there) {
  const Settings a = ListFields(here), b = ListFields(there);
  const auto [in_a, in_b] = std::ranges::mismatch(a, b);
  if (in_a == a.end()) return;
  throw InputError(
      fmt::format("{}: condition {}, trial {} is there twice and not equal: {} is {} here, {} in a part "
                  "before; a trial is a "
                  "function of its study, so one of the two was computed by another program or was changed",
                  path, here.problem.condition, here.problem.trial, in_a->first, in_a->second, in_b->second));
}

using HeldTrials = std::vector<Places>;  // per condition

// Notes which planned trials are missing, and to which shards they belong.
void NoteMissing(const HeldTrials& held, const PartDescriptions& descriptions, MergeReport* report) {
  for (const Places& trials : held) report->num_trials += trials.num();
  report->num_shards = descriptions.num_shards();
  if (!report->run.stopping_rule.empty()) return;
  std::set<std::uint32_t> shards;
  const auto repeats = static_cast<std::uint32_t>(report->run.repeats_per_scene);
  for (std::uint32_t c = 0; c < report->run.conditions.size(); ++c) {
    for (std::uint32_t trial = 0; trial < report->run.conditions[c].num_trials; ++trial) {
      if (held[c].Has(trial)) continue;
      ++report->num_missing;
      if (report->num_shards > 0) shards.insert(FindShard(c, trial / repeats, report->num_shards));
    }
  }
  report->missing_shards.assign(shards.begin(), shards.end());
}

}  // namespace

MergeReport MergeResults(const std::vector<std::string>& parts, const std::string& out, bool is_partial,
                         const MergeOptions& options) {
  const PartDescriptions descriptions = DescribeParts(parts, options, nullptr);
  MergeReport report;
  report.run = descriptions.Merged();
  Progress progress("trials merged", descriptions.num_trials());
  NewTrials merged(out, report.run);
  HeldTrials held(report.run.conditions.size());
  for (const std::string& path : parts) {
    ReadPart(path, report.run.identity, [&](const StoredTrial& trial) {
      progress.Advance(1);
      if (held[trial.problem.condition].Add(trial.problem.trial)) return merged.Add(trial);
      CheckEqual(path, trial, merged.Read(trial.problem.condition, trial.problem.trial));
      ++report.num_twice;
    });
  }
  NoteMissing(held, descriptions, &report);
  report.run.shard = ShardsOfMerged(report);
  if (report.num_missing == 0 || is_partial) merged.Finish(report.run);
  return report;
}

MergeReport CheckParts(const std::vector<std::string>& parts, const MergeOptions& options) {
  MergeReport report;
  const PartDescriptions descriptions = DescribeParts(parts, options, &report.unreadable);
  report.run = descriptions.Merged();
  HeldTrials held(report.run.conditions.size());
  for (const std::string& path : parts) {
    HeldTrials of_part(held.size());  // dropped if the part is damaged at its end
    try {
      ReadPart(path, report.run.identity,
               [&](const StoredTrial& trial) { of_part[trial.problem.condition].Add(trial.problem.trial); });
      for (size_t c = 0; c < held.size(); ++c) held[c].AddAll(of_part[c]);
    } catch (const InputError& error) {
      if (std::ranges::count(report.unreadable, error.what()) == 0) report.unreadable.push_back(error.what());
    }
  }
  NoteMissing(held, descriptions, &report);
  return report;
}

}  // namespace rcme
