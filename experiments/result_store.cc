#include "experiments/result_store.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>

#include "experiments/study_file.h"
#include "experiments/trial_fields.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr const char* kFormat = "rcme results 3";
constexpr std::chrono::milliseconds kCommitInterval{500};
using Clock = std::chrono::steady_clock;

// The two tables of records; everything about them follows from the fields.
template <typename Record>
struct Table;
template <>
struct Table<ProblemRecord> {
  static constexpr const char* kName = "problems";
  static constexpr const char* kKey = "condition, trial";
  static void Visit(auto& record, auto&& visit) { VisitProblemFields(record, visit); }
};
template <>
struct Table<TrialRecord> {
  static constexpr const char* kName = "trials";
  static constexpr const char* kKey = "condition, trial, estimator";
  static void Visit(auto& record, auto&& visit) { VisitFields(record, visit); }
};

// "condition, trial, ..." with `make(name, field)` for each column.
template <typename Record, typename Make>
std::string JoinFields(Make make) {
  Record record;
  std::vector<std::string> parts;
  Table<Record>::Visit(record,
                       [&](const char* name, const auto& field) { parts.push_back(make(name, field)); });
  return fmt::format("{}", fmt::join(parts, ", "));
}

template <typename Record>
std::string CreateTable() {
  const std::string columns = JoinFields<Record>([](const char* name, const auto& field) {
    using Field = std::decay_t<decltype(field)>;
    const char* type = std::is_same_v<Field, double>         ? "REAL"
                       : std::is_same_v<Field, MotionStatus> ? "TEXT NOT NULL"
                                                             : "INTEGER NOT NULL";
    return fmt::format("{} {}", name, type);
  });
  return fmt::format("CREATE TABLE {} ({}, PRIMARY KEY ({})) WITHOUT ROWID", Table<Record>::kName, columns,
                     Table<Record>::kKey);
}

template <typename Record>
std::string InsertInto() {
  return fmt::format("INSERT INTO {} VALUES ({})", Table<Record>::kName,
                     JoinFields<Record>([](const char*, const auto&) { return "?"; }));
}

template <typename Record>
std::string SelectFrom(const std::string& where) {
  return fmt::format("SELECT {} FROM {} {} ORDER BY {}",
                     JoinFields<Record>([](const char* name, const auto&) { return std::string(name); }),
                     Table<Record>::kName, where, Table<Record>::kKey);
}

template <typename Record>
void Bind(SQLite::Statement& statement, const Record& record) {
  int column = 1;
  Table<Record>::Visit(record, [&](const char*, const auto& field) {
    using Field = std::decay_t<decltype(field)>;
    if constexpr (std::is_same_v<Field, MotionStatus>) {
      statement.bindNoCopy(column, StatusName(field));
    } else if constexpr (std::is_same_v<Field, double>) {
      statement.bind(column, field);  // NaN becomes NULL
    } else {
      statement.bind(column, static_cast<std::int64_t>(field));
    }
    ++column;
  });
}

MotionStatus StatusFromName(const std::string& name) {
  for (const MotionStatus status : AllStatuses()) {
    if (StatusName(status) == name) return status;
  }
  throw InputError(fmt::format("status '{}' is unknown to this version of rcme", name));
}

template <typename Record>
Record ReadRecord(SQLite::Statement& row) {
  Record record;
  int index = 0;
  Table<Record>::Visit(record, [&](const char*, auto& field) {
    const SQLite::Column column = row.getColumn(index++);
    using Field = std::decay_t<decltype(field)>;
    if constexpr (std::is_same_v<Field, MotionStatus>) {
      field = StatusFromName(column.getString());
    } else if constexpr (std::is_same_v<Field, double>) {
      field = column.isNull() ? std::numeric_limits<double>::quiet_NaN() : column.getDouble();
    } else {
      field = static_cast<Field>(column.getInt64());
    }
  });
  return record;
}

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

}  // namespace

struct ResultStore::Connection {
  // By the absolute path: SQLite reads '', ':memory:' and 'file:...' as something else than a file of that
  // name. Without SQLite's own locks, which cost a tenth of an insertion: a store has one caller at a time.
  Connection(const std::string& file, int flags)
      : path(file), database(std::filesystem::absolute(file).string(), flags | SQLite::OPEN_NOMUTEX) {
    database.setBusyTimeout(1000);
  }

  // Runs `action`; an error of the database names the file.
  template <typename Action>
  auto Guarded(Action action) const {
    try {
      return action();
    } catch (const SQLite::Exception& error) {
      throw InputError(fmt::format("{}: {}", path, Reason(error)));
    }
  }

  static std::string Reason(const SQLite::Exception& error) {
    switch (error.getErrorCode()) {
      case SQLITE_NOTADB:
      case SQLITE_CORRUPT:
        return "is not an rcme result file, or is damaged";
      case SQLITE_BUSY:
      case SQLITE_LOCKED:
        return "is in use by another run";
      case SQLITE_FULL:
      case SQLITE_IOERR:
        return fmt::format("cannot be written ({}); trials committed before are safe", error.what());
      case SQLITE_CANTOPEN:
      case SQLITE_READONLY:
        return fmt::format("cannot be opened for writing ({})", error.what());
      default:
        return error.what();
    }
  }

  std::optional<std::string> Value(const std::string& key) {
    if (!database.tableExists("run")) return std::nullopt;
    SQLite::Statement query(database, "SELECT value FROM run WHERE key = ?");
    query.bind(1, key);
    return query.executeStep() ? std::optional<std::string>(query.getColumn(0).getString()) : std::nullopt;
  }

  void CheckFormat() {
    if (Value("format") != kFormat)
      throw InputError(fmt::format("{}: is not an rcme result file ({})", path, kFormat));
  }

  void Create(const StudyPlan& plan) {
    SQLite::Transaction creation(database);
    database.exec("CREATE TABLE run (key TEXT PRIMARY KEY, value TEXT NOT NULL)");
    database.exec(
        "CREATE TABLE conditions (condition INTEGER, factor TEXT, level TEXT, PRIMARY KEY (condition, "
        "factor))");
    database.exec("CREATE TABLE estimators (estimator INTEGER PRIMARY KEY, label TEXT NOT NULL)");
    database.exec(CreateTable<ProblemRecord>());
    database.exec(CreateTable<TrialRecord>());
    SetValue("format", kFormat);
    SetValue("identity", plan.identity);
    for (const Condition& condition : plan.conditions) {
      for (size_t f = 0; f < plan.factor_names.size(); ++f) {
        Insert("INSERT INTO conditions VALUES (?, ?, ?)", static_cast<std::int64_t>(condition.index),
               plan.factor_names[f], condition.levels[f]);
      }
    }
    for (size_t e = 0; e < plan.study.estimators.size(); ++e) {
      Insert("INSERT INTO estimators VALUES (?, ?)", static_cast<std::int64_t>(e),
             plan.study.estimators[e].label);
    }
    creation.commit();
  }

  // A file without a trial (its run failed at once) takes any study.
  void AdoptIfEmpty(const StudyPlan& plan) {
    if (Value("identity") == plan.identity) return;
    if (database.execAndGet("SELECT count(*) FROM (SELECT 1 FROM trials LIMIT 1)").getInt() > 0) return;
    for (const char* table : {"run", "conditions", "estimators", "problems", "trials"}) {
      database.exec(fmt::format("DROP TABLE {}", table));
    }
    Create(plan);
  }

  // The study with the trials that earlier runs asked for, if those were more.
  std::string StudyToKeep(const StudyPlan& plan) {
    Study study = plan.study;
    const std::optional<std::string> earlier = Value("study");
    if (earlier) study.trials = std::max(study.trials, ParseStudy(*earlier, path + " (its study)").trials);
    return ToYaml(study);
  }

  void SetValue(const std::string& key, const std::string& value) {
    Insert("INSERT OR REPLACE INTO run VALUES (?, ?)", key, value);
  }

  template <typename... Values>
  void Insert(const char* sql, const Values&... values) {
    SQLite::Statement statement(database, sql);
    int index = 1;
    (statement.bind(index++, values), ...);
    statement.exec();
  }

  // Runs `action`; an error takes back all that is not committed: a transaction holds whole calls only.
  template <typename Action>
  void OrRollBack(Action action) {
    try {
      action();
    } catch (...) {
      insert_problem->tryReset();
      insert_trial->tryReset();
      transaction.reset();
      throw;
    }
  }

  template <typename Record>
  static void InsertAll(const std::vector<Record>& records, SQLite::Statement* insert) {
    for (const Record& record : records) {
      Bind(*insert, record);
      insert->exec();
      insert->reset();
    }
  }

  void Add(const std::vector<ProblemRecord>& problems, const std::vector<TrialRecord>& records) {
    if (!transaction) transaction.emplace(database);
    OrRollBack([&] {
      InsertAll(problems, &*insert_problem);
      InsertAll(records, &*insert_trial);
    });
    if (Clock::now() - last_commit > kCommitInterval) Commit();
  }

  void Commit() {
    if (!transaction) return;
    OrRollBack([&] { transaction->commit(); });
    transaction.reset();
    last_commit = Clock::now();
  }

  std::string path;
  SQLite::Database database;
  std::optional<SQLite::Statement> insert_problem, insert_trial;
  std::optional<SQLite::Transaction> transaction;
  Clock::time_point last_commit = Clock::now();
};

ResultStore::ResultStore(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}
ResultStore::ResultStore(ResultStore&&) noexcept = default;

ResultStore::~ResultStore() {
  if (!connection_) return;
  try {
    connection_->Commit();
  } catch (const SQLite::Exception&) {
    // The transaction is rolled back; its trials will be run again on resume.
  }
}

ResultStore ResultStore::OpenForRun(const std::string& path, const StudyPlan& plan) {
  if (path.empty()) throw InputError("--out: '' is not allowed; give the path of a result file");
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  if (std::filesystem::is_directory(path))
    throw InputError(fmt::format("{}: is a folder, not a result file", path));
  if (!parent.empty() && !std::filesystem::is_directory(parent)) {
    throw InputError(fmt::format("{}: folder '{}' does not exist", path, parent.string()));
  }
  try {
    auto connection = std::make_unique<Connection>(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    SQLite::Database& database = connection->database;
    database.exec("PRAGMA locking_mode = EXCLUSIVE");
    database.exec("BEGIN IMMEDIATE; COMMIT");  // take the lock now: a second run stops here
    const bool is_new = database.execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0;
    if (is_new) connection->Create(plan);
    connection->CheckFormat();
    connection->AdoptIfEmpty(plan);
    const std::string identity = connection->Value("identity").value_or("");
    if (identity != plan.identity) {
      throw InputError(
          fmt::format("{}: holds the results of another study; first difference: {}. Give another --out",
                      path, FirstDifference(identity, plan.identity)));
    }
    connection->SetValue("study", connection->StudyToKeep(plan));
    connection->insert_problem.emplace(database, InsertInto<ProblemRecord>());
    connection->insert_trial.emplace(database, InsertInto<TrialRecord>());
    return ResultStore(std::move(connection));
  } catch (const SQLite::Exception& error) {
    throw InputError(fmt::format("{}: {}", path, Connection::Reason(error)));
  }
}

ResultStore ResultStore::OpenForReading(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) throw InputError(fmt::format("{}: no such result file", path));
  try {
    // Read-write where possible: a run that was killed leaves a journal, and rolling it back needs to write.
    std::unique_ptr<Connection> connection;
    try {
      connection = std::make_unique<Connection>(path, SQLite::OPEN_READWRITE);
      connection->CheckFormat();
    } catch (const SQLite::Exception&) {
      connection = std::make_unique<Connection>(path, SQLite::OPEN_READONLY);
      connection->CheckFormat();
    }
    return ResultStore(std::move(connection));
  } catch (const SQLite::Exception& error) {
    throw InputError(fmt::format("{}: {}", path, Connection::Reason(error)));
  }
}

StudyPlan ResultStore::Plan() const {
  const std::string& path = connection_->path;
  const auto value = [&](const std::string& key) {
    return connection_->Guarded([&] { return connection_->Value(key).value_or(""); });
  };
  StudyPlan plan = PlanOf(ParseStudy(value("study"), path + " (its study)"), path);
  if (plan.identity != value("identity")) {
    throw InputError(fmt::format("{}: the data of its study have changed since: {}", path,
                                 FirstDifference(value("identity"), plan.identity)));
  }
  if (StoppingRule().empty()) return plan;
  connection_->Guarded([&] {
    SQLite::Statement done(connection_->database, "SELECT count(*) FROM problems WHERE condition = ?");
    for (Condition& condition : plan.conditions) {
      done.bind(1, condition.index);
      done.executeStep();
      condition.num_trials = done.getColumn(0).getInt();
      done.reset();
    }
  });
  return plan;
}

std::vector<TrialRange> ResultStore::MissingTrials(std::uint32_t condition, std::uint32_t num_trials) {
  return connection_->Guarded([&] {
    SQLite::Statement query(connection_->database,
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
  connection_->Guarded([&] { connection_->Add(problems, records); });
}

void ResultStore::Commit() {
  connection_->Guarded([&] { connection_->Commit(); });
}

void ResultStore::NoteStoppingRule(const std::string& rule) {
  connection_->Guarded([&] { connection_->SetValue("stopping rule", rule); });
}

std::string ResultStore::StoppingRule() const {
  return connection_->Guarded([&] { return connection_->Value("stopping rule").value_or(""); });
}

void ResultStore::NoteUntilOptions(const std::string& options, std::int64_t num_trials) {
  connection_->Guarded([&] {
    connection_->SetValue("until options", options);
    connection_->SetValue("until trials", std::to_string(num_trials));
  });
}

std::string ResultStore::UntilOptionsOfAll() const {
  return connection_->Guarded([&] {
    const std::string num_trials =
        connection_->database.execAndGet("SELECT count(*) FROM problems").getString();
    const bool is_all = connection_->Value("until trials") == num_trials;
    return is_all ? connection_->Value("until options").value_or("") : std::string();
  });
}

void ResultStore::ForEachRecord(const std::function<void(const TrialRecord&)>& visit) const {
  connection_->Guarded([&] {
    SQLite::Statement query(connection_->database, SelectFrom<TrialRecord>(""));
    while (query.executeStep()) visit(ReadRecord<TrialRecord>(query));
  });
}

void ResultStore::ForEachTrial(
    const std::function<void(const ProblemRecord&, const std::vector<TrialRecord>&)>& visit,
    std::optional<std::uint32_t> condition) const {
  connection_->Guarded([&] {
    const std::string where = condition ? fmt::format("WHERE condition = {}", *condition) : "";
    SQLite::Statement problems(connection_->database, SelectFrom<ProblemRecord>(where));
    SQLite::Statement trials(connection_->database, SelectFrom<TrialRecord>(where));
    bool has_trial = trials.executeStep();
    std::vector<TrialRecord> records;
    while (problems.executeStep()) {
      const ProblemRecord problem = ReadRecord<ProblemRecord>(problems);
      const auto is_of_problem = [&](const TrialRecord& record) {
        return record.condition == problem.condition && record.trial == problem.trial;
      };
      records.clear();
      for (; has_trial; has_trial = trials.executeStep()) {
        const TrialRecord record = ReadRecord<TrialRecord>(trials);
        if (!is_of_problem(record)) break;
        records.push_back(record);
      }
      visit(problem, records);
    }
  });
}

std::vector<TrialRecord> ResultStore::RecordsOf(std::uint32_t condition, std::uint32_t trial) const {
  return connection_->Guarded([&] {
    SQLite::Statement query(connection_->database,
                            SelectFrom<TrialRecord>("WHERE condition = ? AND trial = ?"));
    query.bind(1, condition);
    query.bind(2, trial);
    std::vector<TrialRecord> records;
    while (query.executeStep()) records.push_back(ReadRecord<TrialRecord>(query));
    return records;
  });
}

}  // namespace rcme
