#include "experiments/result_file/result_file.h"

#include <fmt/format.h>

#include "experiments/base/progress.h"
#include "experiments/result_file/checksum.h"
#include "experiments/result_file/schema.h"

namespace rcme {

ResultFile::ResultFile(const std::string& file, int sqlite_flags)
    : path(file), database(OpenDatabase(file, sqlite_flags)) {}

bool ResultFile::IsNew() {
  return database.execAndGet("PRAGMA page_count").getInt() <= 1 &&
         database.execAndGet("SELECT count(*) FROM sqlite_schema").getInt() == 0;
}

void ResultFile::Create(const StudyPlan& plan) {
  SQLite::Transaction creation(database);
  CreateTables(database);
  run = RunTable::Write(database, plan);
  totals = TrialTotals::Write(database, plan.conditions.size());
  creation.commit();
}

void ResultFile::CreateAnew(const StudyPlan& plan) {
  SQLite::Transaction replacement(database);
  DropTables(database);
  CreateTables(database);
  run = RunTable::Write(database, plan);
  totals = TrialTotals::Write(database, plan.conditions.size());
  replacement.commit();
}

void ResultFile::Load() {
  CheckFormat(database, path);
  CheckSchema(database);
  run = RunTable::Read(database);
  totals = TrialTotals::Read(database);
  Progress progress("trials checked", totals.NumTrials());
  ForEachTrial(std::nullopt, [&](const StoredTrial&) { progress.Advance(1); });
}

void ResultFile::CheckPages() {
  const std::string finding = database.execAndGet("PRAGMA quick_check(1)").getString();
  if (finding != "ok") throw Damage(finding);
}

void ResultFile::CheckFits(const StudyPlan& plan) const {
  if (plan.conditions.size() != totals.num_conditions() || plan.estimators.size() != run.num_estimators())
    throw Damage("its tables are not those of its study");
}

TrialFrame ResultFile::Frame() const {
  return {ChecksumOf({run.Value("identity")}), totals.num_conditions(), run.num_estimators()};
}

void ResultFile::SetValues(const std::map<std::string, std::string>& values) {
  SQLite::Transaction change(database);
  run.Set(database, values);
  change.commit();
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
