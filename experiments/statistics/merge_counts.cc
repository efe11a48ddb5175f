#include "experiments/statistics/merge_counts.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "experiments/core/files/checksum.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/run/store/counts_tables.h"
#include "experiments/run/store/new_trials.h"
#include "experiments/statistics/run_counts.h"
#include "experiments/statistics/summary_quantities.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

// Returns a checksum per condition of all that a part holds, except the times of calls.
std::vector<std::uint32_t> ComputeDigest(const RunCounts& counts) {
  std::vector<std::uint32_t> digest;
  for (const ConditionCounts& condition : counts.conditions) {
    std::vector<std::string> texts;
    for (const auto& [shard, places] : condition.places) texts.insert(texts.end(), {shard, places.Text()});
    for (const CountedQuantity& row : condition.cell.Texts()) {
      if (IsOfTimes(row.quantity)) continue;
      texts.insert(texts.end(), {row.quantity, std::to_string(row.n), row.sum, row.sum_squares, row.cells});
    }
    digest.push_back(ComputeChecksum(texts));
  }
  return digest;
}

// Adds parts one after the other.
class MergedCounts {
 public:
  MergedCounts(const PartDescriptions& descriptions, MergeReport* report)
      : report_(report), counts_(descriptions.Merged()) {
    report->run = counts_.run;
    report->num_shards = descriptions.num_shards();
    if (report->num_shards == 0) {
      throw InputError("the parts come from different numbers of shards, so their common trials are unknown");
    }
  }

  void Add(const std::string& path) {
    if (IsStopRequested()) throw Stopped("stopped; nothing was written");
    const std::unique_ptr<ResultFile> file = OpenPart(path);
    const RunCounts part = NamingFile(path, [&] { return ReadCounts(*file); });
    const std::vector<std::uint32_t> digest = ComputeDigest(part);
    if (HasCommonTrials(part)) {
      if (!digests_.contains(digest)) {
        throw InputError(fmt::format(
            "{}: counts trials that an earlier part counts with other numbers; leave out one of the two",
            path));
      }
      report_->num_twice += part.NumTrials();
      return;
    }
    digests_.insert(digest);
    for (size_t c = 0; c < counts_.conditions.size(); ++c) AddCondition(part.conditions[c], c);
  }

  void NoteMissing() {
    report_->num_trials = counts_.NumTrials();
    std::set<std::uint32_t> shards;
    for (std::uint32_t c = 0; c < counts_.conditions.size(); ++c) {
      const auto num_trials = static_cast<std::uint32_t>(counts_.run.conditions[c].num_trials);
      for (std::uint32_t number = 1; number <= report_->num_shards; ++number) {
        const Shard shard{number, report_->num_shards};
        const std::uint32_t end = ShardTrials(shard, c, 1).NumBefore(num_trials);
        for (const TrialRange& range : counts_.conditions[c].FindPlaces(shard.Text()).Missing(end)) {
          report_->num_missing += range.end - range.first;
          shards.insert(number);
        }
      }
    }
    report_->missing_shards.assign(shards.begin(), shards.end());
    report_->run.shard = ShardsOfMerged(*report_);
  }

  void Write(const std::string& out) {
    if (report_->num_missing == 0) NoteThatAllIsCounted();
    counts_.run = report_->run;
    NewResultFile merged(out, counts_.run);
    std::set<std::uint32_t> all;
    for (std::uint32_t c = 0; c < counts_.conditions.size(); ++c) all.insert(c);
    NamingFile(out, [&] { WriteCounts(counts_, all, &merged.file()); });
    merged.Finish(counts_.run);
  }

 private:
  bool HasCommonTrials(const RunCounts& part) const {
    for (size_t c = 0; c < part.conditions.size(); ++c) {
      for (const auto& [shard, places] : part.conditions[c].places) {
        if (places.Intersects(counts_.conditions[c].FindPlaces(shard))) return true;
      }
    }
    return false;
  }

  void AddCondition(const ConditionCounts& part, size_t condition) {
    ConditionCounts& merged = counts_.conditions[condition];
    merged.cell.Merge(part.cell);
    for (const auto& [shard, places] : part.places) merged.places[shard].AddAll(places);
    for (const auto& [number, trial] : part.kept.All()) merged.kept.Add(trial, counts_.run.failure);
  }

  // The merged file no longer distinguishes shards.
  void NoteThatAllIsCounted() {
    for (ConditionCounts& condition : counts_.conditions) {
      const std::int64_t num_trials = condition.cell.num_trials();
      condition.places = {{"", Places::First(static_cast<std::uint32_t>(num_trials))}};
    }
  }

  MergeReport* report_;
  RunCounts counts_;
  std::set<std::vector<std::uint32_t>> digests_;  // of the parts added so far
};

}  // namespace

MergeReport MergeCounts(const std::vector<std::string>& parts, const std::string& out, bool is_partial,
                        const MergeOptions& options) {
  MergeReport report;
  MergedCounts merged(DescribeParts(parts, options, nullptr), &report);
  for (const std::string& path : parts) merged.Add(path);
  merged.NoteMissing();
  if (report.num_missing == 0 || is_partial) merged.Write(out);
  return report;
}

MergeReport CheckCounts(const std::vector<std::string>& parts, const MergeOptions& options) {
  MergeReport report;
  const PartDescriptions descriptions = DescribeParts(parts, options, &report.unreadable);
  std::vector<std::string> unreadable = report.unreadable;
  MergedCounts merged(descriptions, &report);
  for (const std::string& path : parts) {
    try {
      merged.Add(path);
    } catch (const InputError& error) {
      if (std::ranges::count(unreadable, error.what()) == 0) unreadable.push_back(error.what());
    }
  }
  merged.NoteMissing();
  report.unreadable = unreadable;
  return report;
}

}  // namespace rcme
