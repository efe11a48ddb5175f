#include "experiments/run/store/result_store.h"

#include <fmt/format.h>

#include <algorithm>

#include "estimator/instruction_set.h"
#include "experiments/core/files/first_difference.h"
#include "experiments/core/text/program_name.h"
#include "experiments/run/store/open_for_run.h"
#include "experiments/run/store/trial_writer.h"
#include "experiments/study/command_files.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

void CheckKeepsTrials(const ResultFile& file) {
  if (!file.description.keeps_counts) return;
  throw InputError(fmt::format(
      "{}: holds counts, not trials (--keep counts): `rcme summarize` and `rcme merge` read it", file.path));
}

// Adds the program that made the file to an InputError of `work`.
template <typename Work>
auto NamingProgram(const RunDescription& run, Work work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}; the file was made by {}", error.what(), run.origin.program));
  }
}

}  // namespace

TrialOrigin ThisProgram() { return {ProgramName(), InstructionSetName()}; }

struct ResultStore::Connection {
  explicit Connection(std::unique_ptr<ResultFile> opened) : owned(std::move(opened)) {}

  void Set(const RunDescription& run) {
    if (writer) writer->Commit();
    file.SetDescription(run);
  }

  const std::unique_ptr<ResultFile> owned;
  ResultFile& file = *owned;
  std::optional<TrialWriter> writer;
  bool are_trials_checked = false;
};

ResultStore::ResultStore(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}
ResultStore::ResultStore(ResultStore&&) noexcept = default;

ResultStore::~ResultStore() {
  if (!connection_ || !connection_->writer) return;
  try {
    connection_->writer->Commit();
  } catch (const SQLite::Exception&) {
    // The transaction is rolled back; resuming the run computes its trials again.
  }
}

ResultStore ResultStore::OpenForRun(const std::string& path, const StudyPlan& plan, const Shard& shard) {
  return NamingFile(path, [&] {
    auto connection = std::make_unique<Connection>(OpenFileForRun(path, plan, shard, Keep::kTrials));
    connection->are_trials_checked = true;
    connection->writer.emplace(&connection->file);
    return ResultStore(std::move(connection));
  });
}

ResultStore ResultStore::OpenForReading(const std::string& path) {
  RequireResultFile(path);
  return NamingFile(path, [&] {
    // Opened read-write if possible, because rolling back the journal of a killed run writes to the file.
    auto connection =
        std::make_unique<Connection>(std::make_unique<ResultFile>(path, SQLite::OPEN_READWRITE));
    connection->file.database.exec("BEGIN");  // what is checked is what will be read, even if somebody writes
    connection->file.LoadDescription();
    CheckKeepsTrials(connection->file);
    return ResultStore(std::move(connection));
  });
}

void ResultStore::CheckTrials() const {
  if (connection_->are_trials_checked) return;
  NamingFile(connection_->file.path, [&] { connection_->file.CheckTrials(); });
  connection_->are_trials_checked = true;
}

const std::string& ResultStore::path() const { return connection_->file.path; }

RunDescription ResultStore::Description() const {
  const ResultFile& file = connection_->file;
  RunDescription run = file.description;
  if (run.until_trials != file.totals.NumTrials()) run.until_options.clear();
  if (run.stopping_rule.empty()) return run;
  for (size_t c = 0; c < run.conditions.size(); ++c)
    run.conditions[c].num_trials = file.totals.Of(c).num_trials;
  return run;
}

Study ResultStore::StoredStudy() const {
  const RunDescription& run = connection_->file.description;
  return NamingProgram(run,
                       [&] { return ParseStudy(run.study_yaml, connection_->file.path + " (its study)"); });
}

StudyPlan ResultStore::Plan(const Study& stored, PlanEstimators estimators) const {
  const std::string& path = connection_->file.path;
  if (estimators == PlanEstimators::kMade) RequireAllowedCommands(stored.estimators);
  const RunDescription run = Description();
  if (!run.stopping_rule.empty()) CheckTrials();
  StudyPlan plan = NamingProgram(run, [&] { return MakePlan(stored, path, estimators); });
  if (const auto changed = FindChangedCommandFile(run.identity, plan.identity)) {
    throw InputError(fmt::format(
        "{}: its trials cannot be run again: {} is not what it was; restore the file", path, *changed));
  }
  if (plan.identity != run.identity) {
    throw InputError(fmt::format("{}: the data of its study have changed since: {}", path,
                                 FirstDifference(run.identity, plan.identity)));
  }
  NamingFile(path, [&] { CheckFits(run, plan); });
  for (Condition& condition : plan.conditions) {
    condition.num_trials = static_cast<int>(run.conditions[condition.index].num_trials);
  }
  return plan;
}

std::vector<TrialRange> ResultStore::MissingTrials(std::uint32_t condition, std::uint32_t num_trials,
                                                   const ShardTrials& shard) {
  CheckTrials();
  return NamingFile(connection_->file.path, [&] {
    SQLite::Statement query(connection_->file.database,
                            "SELECT trial FROM problems WHERE condition = ? AND trial < ? ORDER BY trial");
    SQLite::bind(query, condition, num_trials);
    std::vector<TrialRange> missing;
    std::uint32_t next = 0;
    while (query.executeStep()) {
      const auto trial = static_cast<std::uint32_t>(query.getColumn(0).getInt64());
      if (!shard.Has(trial)) continue;
      const std::uint32_t done = shard.NumBefore(trial);
      if (next < done) missing.push_back({next, done});
      next = done + 1;
    }
    const std::uint32_t end = shard.NumBefore(num_trials);
    if (next < end) missing.push_back({next, end});
    return missing;
  });
}

void ResultStore::Add(const std::vector<ProblemRecord>& problems, const std::vector<TrialRecord>& records) {
  NamingFile(connection_->file.path, [&] { connection_->writer.value().Add(problems, records); });
}

void ResultStore::Commit() {
  NamingFile(connection_->file.path, [&] { connection_->writer.value().Commit(); });
}

std::int64_t ResultStore::RemoveForRetry(const std::vector<MotionStatus>& statuses) {
  return NamingFile(connection_->file.path, [&] {
    connection_->writer.value().Commit();
    return connection_->file.RemoveForRetry(statuses);
  });
}

void ResultStore::Set(const RunDescription& run) {
  NamingFile(connection_->file.path, [&] { connection_->Set(run); });
}

void ResultStore::NoteStoppingRule(const std::string& rule) {
  RunDescription run = connection_->file.description;
  run.stopping_rule = rule;
  Set(run);
}

void ResultStore::NoteUntilOptions(const std::string& options, std::int64_t num_trials) {
  RunDescription run = connection_->file.description;
  run.until_options = options;
  run.until_trials = num_trials;
  Set(run);
}

std::int64_t ResultStore::NumTrials() const { return connection_->file.totals.NumTrials(); }

std::string ResultStore::NoteOrigin(const TrialOrigin& origin) {
  RunDescription run = connection_->file.description;
  const TrialOrigin before = run.origin;
  const std::string warning = NoteOriginIn(&run, connection_->file.path, NumTrials() > 0, origin);
  if (run.origin != before) Set(run);
  return warning;
}

void ResultStore::ForEachRecord(const std::function<void(const TrialRecord&)>& visit) const {
  ForEachTrial([&](const ProblemRecord&, const std::vector<TrialRecord>& records) {
    for (const TrialRecord& record : records) visit(record);
  });
}

void ResultStore::ForEachTrial(
    const std::function<void(const ProblemRecord&, const std::vector<TrialRecord>&)>& visit,
    std::optional<std::uint32_t> condition) const {
  NamingFile(connection_->file.path, [&] {
    connection_->file.ForEachTrial(condition,
                                   [&](const StoredTrial& trial) { visit(trial.problem, trial.records); });
  });
  if (!condition) connection_->are_trials_checked = true;
}

std::vector<TrialRecord> ResultStore::ReadTrialRecords(std::uint32_t condition, std::uint32_t trial) const {
  const auto found = NamingFile(connection_->file.path, [&] {
    const ResultFile& file = connection_->file;
    return ReadStoredTrial(file.database, file.Frame(), condition, trial);
  });
  if (found) return found->records;
  CheckTrials();
  return {};
}

}  // namespace rcme
