#include "experiments/result_file/result_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "estimator/instruction_set.h"
#include "experiments/result_file/result_file.h"
#include "experiments/result_file/trial_writer.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

// The first line in which two identities differ, as "'a' there, 'b' here".
std::string FirstDifference(const std::string& there, const std::string& here) {
  std::istringstream a(there), b(here);
  std::string line_a, line_b;
  while (true) {
    const bool has_a = static_cast<bool>(std::getline(a, line_a));
    const bool has_b = static_cast<bool>(std::getline(b, line_b));
    if (!has_a) line_a = "(nothing)";
    if (!has_b) line_b = "(nothing)";
    if (line_a != line_b || (!has_a && !has_b)) return fmt::format("'{}' there, '{}' here", line_a, line_b);
  }
}

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

}  // namespace

TrialOrigin ThisProgram() { return {"rcme " RCME_VERSION, InstructionSetName()}; }

struct ResultStore::Connection {
  Connection(const std::string& path, int sqlite_flags) : file(path, sqlite_flags) {}

  void Set(const std::map<std::string, std::string>& values) {
    if (writer) writer->Commit();
    file.SetValues(values);
  }

  // The study with the trials that earlier runs asked for, if those were more.
  void KeepStudy(const StudyPlan& plan) {
    const std::string earlier = file.run.Value("study");
    Study study = plan.study;
    study.trials = std::max(study.trials, ParseStudy(earlier, file.path + " (its study)").trials);
    const std::string yaml = ToYaml(study);
    if (yaml != earlier) Set({{"study", yaml}});
  }

  ResultFile file;
  std::optional<TrialWriter> writer;
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

ResultStore ResultStore::OpenForRun(const std::string& path, const StudyPlan& plan) {
  CheckPathToWrite(path);
  return NamingFile(path, [&] {
    auto connection = std::make_unique<Connection>(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    ResultFile& file = connection->file;
    file.database.exec("PRAGMA locking_mode = EXCLUSIVE");
    file.database.exec("BEGIN IMMEDIATE; COMMIT");  // take the lock now: a second run stops here
    if (file.IsNew()) {
      file.Create(plan);
    } else {
      file.Load();
      file.CheckPages();
    }
    // A file without a trial (its run failed at once) takes any study.
    const std::string identity = file.run.Value("identity");
    if (identity != plan.identity && file.totals.NumTrials() > 0) {
      throw InputError(
          fmt::format("{}: holds the results of another study; first difference: {}. Give another --out",
                      path, FirstDifference(identity, plan.identity)));
    }
    if (identity != plan.identity) file.CreateAnew(plan);
    file.CheckFits(plan);
    connection->KeepStudy(plan);
    connection->writer.emplace(&file);
    return ResultStore(std::move(connection));
  });
}

ResultStore ResultStore::OpenForReading(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) throw InputError(fmt::format("{}: no such result file", path));
  return NamingFile(path, [&] {
    // Read-write where that is allowed: rolling back the journal of a run that was killed needs to write.
    auto connection = std::make_unique<Connection>(path, SQLite::OPEN_READWRITE);
    connection->file.database.exec("BEGIN");  // what is checked is what will be read, whoever writes
    connection->file.Load();
    return ResultStore(std::move(connection));
  });
}

StudyPlan ResultStore::Plan() const {
  const ResultFile& file = connection_->file;
  StudyPlan plan = PlanOf(ParseStudy(file.run.Value("study"), file.path + " (its study)"), file.path);
  if (plan.identity != file.run.Value("identity")) {
    throw InputError(fmt::format("{}: the data of its study have changed since: {}", file.path,
                                 FirstDifference(file.run.Value("identity"), plan.identity)));
  }
  NamingFile(file.path, [&] { file.CheckFits(plan); });
  if (StoppingRule().empty()) return plan;
  for (Condition& condition : plan.conditions) {
    condition.num_trials = static_cast<int>(file.totals.Of(condition.index).num_trials);
  }
  return plan;
}

std::vector<TrialRange> ResultStore::MissingTrials(std::uint32_t condition, std::uint32_t num_trials) {
  return NamingFile(connection_->file.path, [&] {
    SQLite::Statement query(connection_->file.database,
                            "SELECT trial FROM problems WHERE condition = ? AND trial < ? ORDER BY trial");
    query.bind(1, condition);
    query.bind(2, num_trials);
    std::vector<TrialRange> missing;
    std::uint32_t next = 0;
    while (query.executeStep()) {
      const auto done = static_cast<std::uint32_t>(query.getColumn(0).getInt64());
      if (next < done) missing.push_back({next, done});
      next = done + 1;
    }
    if (next < num_trials) missing.push_back({next, num_trials});
    return missing;
  });
}

void ResultStore::Add(const std::vector<ProblemRecord>& problems, const std::vector<TrialRecord>& records) {
  NamingFile(connection_->file.path, [&] { connection_->writer.value().Add(problems, records); });
}

void ResultStore::Commit() {
  NamingFile(connection_->file.path, [&] { connection_->writer.value().Commit(); });
}

void ResultStore::Set(const std::map<std::string, std::string>& values) {
  NamingFile(connection_->file.path, [&] { connection_->Set(values); });
}

void ResultStore::NoteStoppingRule(const std::string& rule) { Set({{"stopping rule", rule}}); }

std::string ResultStore::StoppingRule() const { return connection_->file.run.Value("stopping rule"); }

void ResultStore::NoteUntilOptions(const std::string& options, std::int64_t num_trials) {
  Set({{"until options", options}, {"until trials", std::to_string(num_trials)}});
}

std::string ResultStore::UntilOptionsOfAll() const {
  const RunTable& run = connection_->file.run;
  const bool is_all = run.Value("until trials") == std::to_string(connection_->file.totals.NumTrials());
  return is_all ? run.Value("until options") : std::string();
}

std::int64_t ResultStore::NumTrials() const { return connection_->file.totals.NumTrials(); }

std::string ResultStore::NoteOrigin(const TrialOrigin& origin) {
  const TrialOrigin before = Origin();
  const TrialOrigin all{WithName(before.program, origin.program),
                        WithName(before.instruction_set, origin.instruction_set)};
  const bool is_known = all.program == before.program && all.instruction_set == before.instruction_set;
  if (!is_known) Set({{"program", all.program}, {"instruction set", all.instruction_set}});
  const bool is_only = all.program == origin.program && all.instruction_set == origin.instruction_set;
  if (is_only || connection_->file.totals.NumTrials() == 0) return {};
  return fmt::format(
      "{}: its trials are of {} ({}), the further ones will be of {} ({}): they may differ in their last "
      "bits",
      connection_->file.path, before.program, before.instruction_set, origin.program, origin.instruction_set);
}

TrialOrigin ResultStore::Origin() const {
  const RunTable& run = connection_->file.run;
  return {run.Value("program"), run.Value("instruction set")};
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
  return NamingFile(connection_->file.path, [&] {
    const ResultFile& file = connection_->file;
    const std::optional<StoredTrial> found = ReadStoredTrial(file.database, file.Frame(), condition, trial);
    return found ? found->records : std::vector<TrialRecord>();
  });
}

}  // namespace rcme
