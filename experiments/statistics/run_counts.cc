#include "experiments/statistics/run_counts.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/run/store/trial_writer.h"
#include "parameters/parameter.h"
#include "parameters/text_lines.h"

namespace rcme {
namespace {

// A bijection of 64 bits whose values look random (the finaliser of SplitMix64, Steele, Lea & Flood 2014).
std::uint64_t HashOfTrial(std::uint32_t condition, std::uint32_t trial) {
  std::uint64_t z = (std::uint64_t{condition} << 32 | trial) + 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

// Keeps the trials with the least hashes.
void KeepByHash(std::uint64_t hash, const StoredTrial& trial, size_t num,
                std::map<std::uint64_t, StoredTrial>* kept) {
  if (kept->size() >= num && hash >= kept->rbegin()->first) return;
  kept->emplace(hash, trial);
  if (kept->size() > num) kept->erase(std::prev(kept->end()));
}

StoredCounts MakeStoredCounts(const ConditionCounts& condition) {
  StoredCounts texts;
  for (const auto& [shard, places] : condition.places) texts.places.push_back({shard, places.Text()});
  texts.quantities = condition.cell.Texts();
  return texts;
}

}  // namespace

void KeptTrials::Add(const StoredTrial& trial, const FailureBounds& bounds) {
  const std::uint64_t hash = HashOfTrial(trial.problem.condition, trial.problem.trial);
  KeepByHash(hash, trial, kNumSampled, &sampled_);
  if (std::ranges::any_of(trial.records, [&](const TrialRecord& r) { return HasFailed(r, bounds); }))
    KeepByHash(hash, trial, kNumFailed, &failed_);
}

std::map<std::uint32_t, StoredTrial> KeptTrials::All() const {
  std::map<std::uint32_t, StoredTrial> all;
  for (const auto* kept : {&sampled_, &failed_}) {
    for (const auto& [hash, trial] : *kept) all.emplace(trial.problem.trial, trial);
  }
  return all;
}

const Places& ConditionCounts::FindPlaces(const std::string& shard) const {
  static const Places none;
  const auto found = places.find(shard);
  return found == places.end() ? none : found->second;
}

RunCounts::RunCounts(const RunDescription& description)
    : run(description), conditions(run.conditions.size(), ConditionCounts(run.estimators.size())) {}

std::int64_t RunCounts::NumTrials() const {
  std::int64_t sum = 0;
  for (const ConditionCounts& condition : conditions) sum += condition.cell.num_trials();
  return sum;
}

RunCounts ReadCounts(const ResultFile& file) {
  if (!file.description.keeps_counts)
    throw InputError(fmt::format("{}: holds trials, not counts", file.path));
  RunCounts counts(file.description);
  const std::vector<StoredCounts> stored = ReadStoredCounts(file);
  for (size_t c = 0; c < stored.size(); ++c) {
    ConditionCounts& condition = counts.conditions[c];
    std::int64_t num_trials = 0;
    for (const CountedPlaces& row : stored[c].places)
      num_trials += (condition.places[row.shard] = Places::FromText(row.places)).num();
    condition.cell = SummaryCell::FromTexts(stored[c].quantities, counts.run.estimators.size(), num_trials);
  }
  file.ForEachTrial(std::nullopt, [&](const StoredTrial& trial) {
    counts.conditions.at(trial.problem.condition).kept.Add(trial, counts.run.failure);
  });
  return counts;
}

void WriteCounts(const RunCounts& counts, const std::set<std::uint32_t>& conditions, ResultFile* file) {
  SQLite::Transaction change(file->database);
  TrialWriter writer(file);
  for (const std::uint32_t c : conditions) {
    const ConditionCounts& condition = counts.conditions[c];
    for (const char* table : {"problems", "trials"})
      file->database.exec(fmt::format("DELETE FROM {} WHERE condition = {}", table, c));
    file->totals.Clear(c);
    for (const auto& [number, trial] : condition.kept.All()) writer.AddTrial(trial.problem, trial.records);
    WriteStoredCounts(file, c, MakeStoredCounts(condition));
  }
  file->totals.WriteChanged(file->database);
  change.commit();
}

}  // namespace rcme
