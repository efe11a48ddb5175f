#include "experiments/result_file/result_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "estimator/instruction_set.h"
#include "experiments/base/program_name.h"
#include "experiments/result_file/first_difference.h"
#include "experiments/result_file/result_file.h"
#include "experiments/result_file/trial_writer.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

void CheckPathToWrite(const std::string& path) {
  if (path.empty()) throw InputError("--out: '' is not allowed; give the path of a result file");
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  if (std::filesystem::is_directory(path))
    throw InputError(fmt::format("{}: is a folder, not a result file", path));
  if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path))
    throw InputError(fmt::format("{}: cannot be written as a result file: it is a device or a pipe", path));
  if (!parent.empty() && !std::filesystem::is_directory(parent))
    throw InputError(fmt::format("{}: folder '{}' does not exist", path, parent.string()));
}

// Names separated by commas, with this one.
std::string WithName(const std::string& names, const std::string& name) {
  if (names.empty()) return name;
  const bool has_it = (", " + names + ",").find(", " + name + ",") != std::string::npos;
  return has_it ? names : names + ", " + name;
}

// The run as a plan asks for it, in a file that earlier runs have written to: what they asked for is still
// asked for, and what they noted stays.
RunDescription Continued(const RunDescription& earlier, const StudyPlan& plan) {
  RunDescription run = Describe(plan);
  if (earlier.trials > run.trials) {
    Study study = plan.study;
    study.trials = run.trials = earlier.trials;
    run.study_yaml = ToYaml(study);
  }
  for (size_t c = 0; c < run.conditions.size(); ++c) {
    run.conditions[c].num_trials = std::max(run.conditions[c].num_trials, earlier.conditions[c].num_trials);
  }
  run.shard = earlier.shard;
  run.stopping_rule = earlier.stopping_rule;
  run.until_options = earlier.until_options;
  run.until_trials = earlier.until_trials;
  run.origin = earlier.origin;
  return run;
}

RunDescription DescribeShard(const StudyPlan& plan, const Shard& shard) {
  RunDescription run = Describe(plan);
  run.shard = shard.Text();
  return run;
}

std::string ShardInWords(const std::string& shard) {
  return shard.empty() ? "all trials of its study" : fmt::format("shard {} of its study", shard);
}

// Throws Damage if a description is not that of its study.
void CheckFits(const RunDescription& run, const StudyPlan& plan) {
  if (plan.conditions.size() != run.conditions.size() || plan.estimators.size() != run.estimators.size())
    throw Damage("its tables are not those of its study");
}

// A read-write connection that no other run shares.
constexpr const char* kTakeLock = "PRAGMA locking_mode = EXCLUSIVE; BEGIN IMMEDIATE; COMMIT";

}  // namespace

TrialOrigin ThisProgram() { return {ProgramName(), InstructionSetName()}; }

struct ResultStore::Connection {
  Connection(const std::string& path, int sqlite_flags) : file(path, sqlite_flags) {}

  void Set(const RunDescription& run) {
    if (writer) writer->Commit();
    file.SetDescription(run);
  }

  ResultFile file;
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
    // The transaction is rolled back; its trials will be run again on resume.
  }
}

ResultStore ResultStore::OpenForRun(const std::string& path, const StudyPlan& plan, const Shard& shard) {
  CheckPathToWrite(path);
  return NamingFile(path, [&] {
    auto connection = std::make_unique<Connection>(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    ResultFile& file = connection->file;
    file.database.exec(kTakeLock);  // now: a second run stops here
    if (file.IsNew()) {
      file.Create(DescribeShard(plan, shard));
    } else {
      file.LoadDescription();
      file.CheckTrials();
      file.CheckPages();
    }
    // A file without a trial (its run failed at once) takes any study and any shard.
    const std::string& identity = file.description.identity;
    if (identity != plan.identity && file.totals.NumTrials() > 0) {
      throw InputError(
          fmt::format("{}: holds the results of another study, run by {}; first difference: {}. Give another "
                      "--out",
                      path, file.description.origin.program, FirstDifference(identity, plan.identity)));
    }
    if (file.description.shard != shard.Text() && file.totals.NumTrials() > 0) {
      throw InputError(fmt::format("{}: is the file of {}, not of {}. Give another --out", path,
                                   ShardInWords(file.description.shard),
                                   shard.count == 1 ? "all trials" : "shard " + shard.Text()));
    }
    if (identity != plan.identity || file.description.shard != shard.Text()) {
      file.CreateAnew(DescribeShard(plan, shard));
    } else {
      CheckFits(file.description, plan);
      const RunDescription run = Continued(file.description, plan);
      if (run.study_yaml != file.description.study_yaml) file.SetDescription(run);
    }
    connection->writer.emplace(&file);
    return ResultStore(std::move(connection));
  });
}

ResultStore ResultStore::Create(const std::string& path, const RunDescription& run) {
  CheckPathToWrite(path);
  if (std::filesystem::exists(path))
    throw InputError(fmt::format("{}: exists already; give a new file", path));
  return NamingFile(path, [&] {
    auto connection = std::make_unique<Connection>(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    connection->file.database.exec(kTakeLock);
    connection->file.Create(run);
    connection->writer.emplace(&connection->file);
    return ResultStore(std::move(connection));
  });
}

ResultStore ResultStore::OpenUnchecked(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) throw InputError(fmt::format("{}: no such result file", path));
  return NamingFile(path, [&] {
    // Read-write where that is allowed: rolling back the journal of a run that was killed needs to write.
    auto connection = std::make_unique<Connection>(path, SQLite::OPEN_READWRITE);
    connection->file.database.exec("BEGIN");  // what is checked is what will be read, whoever writes
    connection->file.LoadDescription();
    return ResultStore(std::move(connection));
  });
}

void ResultStore::CheckTrials() const {
  NamingFile(connection_->file.path, [&] { connection_->file.CheckTrials(); });
  connection_->are_trials_checked = true;
}

ResultStore ResultStore::OpenForReading(const std::string& path) {
  ResultStore store = OpenUnchecked(path);
  store.CheckTrials();
  return store;
}

ResultStore ResultStore::OpenForSingleTrials(const std::string& path) {
  ResultStore store = OpenUnchecked(path);
  // Under a stopping rule the number of trials is that of the totals, which only the trials can confirm.
  if (!store.Description().stopping_rule.empty()) store.CheckTrials();
  return store;
}

RunDescription ResultStore::Description() const {
  const ResultFile& file = connection_->file;
  RunDescription run = file.description;
  if (run.until_trials != file.totals.NumTrials()) run.until_options.clear();
  if (run.stopping_rule.empty()) return run;
  for (size_t c = 0; c < run.conditions.size(); ++c)
    run.conditions[c].num_trials = file.totals.Of(c).num_trials;
  return run;
}

StudyPlan ResultStore::Plan() const {
  const std::string& path = connection_->file.path;
  const RunDescription run = Description();
  StudyPlan plan;
  try {
    plan = PlanOf(ParseStudy(run.study_yaml, path + " (its study)"), path);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}; the file was made by {}", error.what(), run.origin.program));
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
  return NamingFile(connection_->file.path, [&] {
    SQLite::Statement query(connection_->file.database,
                            "SELECT trial FROM problems WHERE condition = ? AND trial < ? ORDER BY trial");
    query.bind(1, condition);
    query.bind(2, num_trials);
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
  run.origin = {WithName(before.program, origin.program),
                WithName(before.instruction_set, origin.instruction_set)};
  if (run.origin != before) Set(run);
  if (run.origin == origin || connection_->file.totals.NumTrials() == 0) return {};
  return fmt::format(
      "{}: its trials are of {} ({}), the further ones will be of {} ({}): they may differ in their last "
      "bits",
      connection_->file.path, before.program, before.instruction_set, origin.program, origin.instruction_set);
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
}

std::vector<TrialRecord> ResultStore::RecordsOf(std::uint32_t condition, std::uint32_t trial) const {
  const auto found = NamingFile(connection_->file.path, [&] {
    const ResultFile& file = connection_->file;
    return ReadStoredTrial(file.database, file.Frame(), condition, trial);
  });
  if (found) return found->records;
  if (!connection_->writer && !connection_->are_trials_checked) CheckTrials();
  return {};
}

}  // namespace rcme
