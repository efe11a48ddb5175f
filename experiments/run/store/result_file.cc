#include "experiments/run/store/result_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "experiments/core/files/checksum.h"
#include "experiments/core/files/regular_file.h"
#include "experiments/core/work/progress.h"
#include "experiments/run/store/schema.h"

namespace rcme {

void RequireResultFile(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw InputError(fmt::format("{}: is a folder, not a result file; give one in it", path));
  RegularFile(path, {"result file", "a result file"});
}

ResultFile::ResultFile(const std::string& file, int sqlite_flags, FileLocks locks)
    : path(file), database(OpenDatabase(file, sqlite_flags, locks)) {}

bool ResultFile::IsNew() {
  return database.execAndGet("PRAGMA page_count").getInt() <= 1 &&
         database.execAndGet("SELECT count(*) FROM sqlite_schema").getInt() == 0;
}

void ResultFile::Create(const RunDescription& run) {
  SQLite::Transaction creation(database);
  if (!IsNew()) DropTables(database);
  CreateTables(database);
  WriteDescription(database, run);
  totals = TrialTotals::Write(database, run.conditions.size());
  creation.commit();
  description = run;
}

void ResultFile::LoadDescription() {
  CheckFormat(database, path);
  CheckSchema(database);
  description = ReadDescription(database);
  totals = TrialTotals::Read(database);
  if (totals.num_conditions() != description.conditions.size())
    throw Damage("table totals has other conditions than the study");
  if (!description.keeps_counts) CheckHasNoCounts();
}

void ResultFile::CheckHasNoCounts() {
  for (const char* table : {"counted", "counts"}) {
    if (database.execAndGet(fmt::format("SELECT count(*) FROM {}", table)).getInt64() > 0)
      throw Damage(fmt::format("table {} has rows, although the file keeps every trial", table));
  }
}

void ResultFile::CheckTrials() const {
  Progress progress("trials checked", totals.NumTrials());
  ForEachTrial(std::nullopt, [&](const StoredTrial&) { progress.Advance(1); });
}

void ResultFile::CheckPages() {
  const std::string finding = database.execAndGet("PRAGMA quick_check(1)").getString();
  if (finding != "ok") throw Damage(finding);
}

TrialFrame ResultFile::Frame() const {
  return {ComputeChecksum({description.identity}), totals.num_conditions(), description.estimators.size()};
}

void ResultFile::SetDescription(const RunDescription& run) {
  SQLite::Transaction change(database);
  WriteDescription(database, run);
  change.commit();
  description = run;
}

std::int64_t ResultFile::RemoveForRetry(const std::vector<MotionStatus>& statuses) {
  std::vector<StoredTrial> removed;
  ForEachTrial(std::nullopt, [&](const StoredTrial& trial) {
    const auto is_retried = [&](const TrialRecord& record) {
      return std::ranges::count(statuses, record.status) > 0;
    };
    if (std::ranges::any_of(trial.records, is_retried))
      removed.push_back({trial.problem, {}, trial.checksum});
  });
  if (removed.empty()) return 0;
  RunDescription run = description;
  run.retried_trials += std::ssize(removed);
  run.until_options.clear();  // they would not produce the trials left in the file
  try {
    SQLite::Transaction change(database);
    for (const char* table : {"trials", "problems"}) {
      SQLite::Statement remove(database,
                               fmt::format("DELETE FROM {} WHERE condition = ? AND trial = ?", table));
      for (const StoredTrial& trial : removed) Execute(remove, trial.problem.condition, trial.problem.trial);
    }
    for (const StoredTrial& trial : removed) totals.Remove(trial.problem.condition, trial.checksum);
    totals.WriteChanged(database);
    WriteDescription(database, run);
    change.commit();
  } catch (...) {
    totals = TrialTotals::Read(database);
    throw;
  }
  description = run;
  return std::ssize(removed);
}

void ResultFile::ForEachTrial(std::optional<std::uint32_t> condition,
                              const std::function<void(const StoredTrial&)>& visit) const {
  std::map<std::uint32_t, TrialTotal> found;
  ForEachStoredTrial(database, Frame(), condition, [&](const StoredTrial& trial) {
    found[trial.problem.condition].Add(trial.checksum);
    visit(trial);
  });
  const auto num_conditions = static_cast<std::uint32_t>(totals.num_conditions());
  const std::uint32_t first = condition.value_or(0), end = condition ? first + 1 : num_conditions;
  for (std::uint32_t c = first; c < end; ++c) {
    if (found[c] == totals.Of(c)) continue;
    throw Damage(fmt::format("condition {}: {} trials were counted, {} are there, or others than those", c,
                             totals.Of(c).num_trials, found[c].num_trials));
  }
}

}  // namespace rcme
