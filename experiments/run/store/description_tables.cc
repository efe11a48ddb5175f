#include "experiments/run/store/description_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "experiments/core/files/checksum.h"
#include "experiments/core/files/database.h"
#include "experiments/run/store/schema.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

constexpr const char *kChecksum = "checksum", *kRuleChecksum = "stopping_rule_checksum";
constexpr std::int64_t kMaxRetriedTrials = std::int64_t{1} << 40;  // far more than any run computes

// The checksum of every row of the tables, except its own, column by column. Whole numbers enter as their
// digits.
std::string ChecksumOfRows(SQLite::Database& database) {
  std::vector<std::string> texts;
  for (const ResultTable& table : ResultTables()) {
    if (std::ranges::count(DescriptionTables(), table.name) == 0) continue;
    SQLite::Statement row(database, fmt::format("SELECT * FROM {}{} ORDER BY {}", table.name,
                                                table.name == "run" ? " WHERE key <> 'checksum'" : "",
                                                fmt::join(table.key, ", ")));
    while (row.executeStep()) {
      for (int c = 0; c < row.getColumnCount(); ++c) {
        const SQLite::Column column = row.getColumn(c);
        const bool is_number = table.columns[static_cast<size_t>(c)].type == "INTEGER";
        texts.push_back(is_number ? std::to_string(IntegerIn(column, table.name.c_str()))
                                  : TextIn(column, table.name.c_str()));
      }
    }
    texts.push_back(table.name);  // separates the tables
  }
  return fmt::format("{:08x}", ComputeChecksum(texts));
}

template <typename... Values>
void Insert(SQLite::Database& database, const char* table, const Values&... values) {
  const std::vector<const char*> places(sizeof...(values), "?");
  SQLite::Statement statement(database,
                              fmt::format("INSERT INTO {} VALUES ({})", table, fmt::join(places, ", ")));
  Execute(statement, values...);
}

// The stopping rule has its own checksum, so it can be recovered if the description is damaged elsewhere.
std::string ChecksumOfStoppingRule(const std::string& identity, const std::string& rule) {
  return fmt::format("{:08x}", ComputeChecksum({identity, rule}));
}

// Returns the rows of the table `run` except the checksum.
std::map<std::string, std::string> ListRunValues(const RunDescription& run) {
  std::map<std::string, std::string> values = {
      {"format", kResultFormat},
      {"name", run.study},
      {"description", run.description},
      {"seed", std::to_string(run.seed)},
      {"trials", std::to_string(run.trials)},
      {"repeats_per_scene", std::to_string(run.repeats_per_scene)},
      {"stopping_rule", run.stopping_rule},
      {kRuleChecksum, ChecksumOfStoppingRule(run.identity, run.stopping_rule)},
      {"until_options", run.until_options},
      {"until_trials", std::to_string(run.until_trials)},
      {"retried_trials", std::to_string(run.retried_trials)},
      {"lock", run.lock},
      {"despite_lock", run.despite_lock},
      {"shard", run.shard},
      {"keep", run.keeps_counts ? "counts" : "all"},
      {"program", run.origin.program},
      {"instruction_set", run.origin.instruction_set},
      {"study", run.study_yaml},
      {"identity", run.identity}};
  Ademp keys;
  for (const auto& [key, text] : Parts(keys)) values["ademp_" + key] = "";
  for (const auto& [key, text] : run.ademp) values["ademp_" + key] = text;
  for (const auto& [key, text] : ListBounds(run.failure)) values[key] = text;
  return values;
}

// The rows of the table `run`. Every key must exist unless it is newer than the format.
class RunValues {
 public:
  explicit RunValues(SQLite::Database& database) {
    SQLite::Statement query(database, "SELECT key, value FROM run");
    while (query.executeStep())
      values_[TextIn(query.getColumn(0), "run")] = TextIn(query.getColumn(1), "run");
  }

  const std::string& Text(const std::string& key) const {
    const auto found = values_.find(key);
    if (found == values_.end()) throw Damage(fmt::format("table run lacks '{}'", key));
    return found->second;
  }

  bool Has(const std::string& key) const { return values_.contains(key); }

  std::int64_t WholeNumber(const std::string& key, std::int64_t max) const {
    long long value = 0;
    if (!ParseInteger(Text(key), &value) || value < 0 || value > max)
      throw Damage(fmt::format("'{}' of table run is not possible", key));
    return value;
  }

  FailureBounds Failure() const {
    FailureBounds bounds;
    for (const Parameter& bound : Parameters(bounds)) {
      try {
        bound.SetFromText(Text(bound.name()));
      } catch (const InputError&) {
        throw Damage(fmt::format("'{}' of table run is not possible", bound.name()));
      }
    }
    return bounds;
  }

 private:
  std::map<std::string, std::string> values_;
};

// No text may act on a terminal, and no name may have two lines, whoever made the file.
void CheckTexts(const RunDescription& run) {
  const auto check_line = [](const std::string& text, const char* table) {
    if (FindNotInLine(text) != std::string::npos)
      throw Damage(fmt::format("table {} has a name with control characters: {}", table, Quoted(text)));
  };
  for (const std::string* text : {&run.study, &run.stopping_rule, &run.until_options, &run.shard,
                                  &run.origin.program, &run.origin.instruction_set})
    check_line(*text, "run");
  for (const std::string& factor : run.factors) check_line(factor, "factors");
  for (const DescribedCondition& condition : run.conditions) {
    for (const std::string& level : condition.levels) check_line(level, "levels");
  }
  for (const DescribedEstimator& estimator : run.estimators) {
    for (const std::string* text : {&estimator.label, &estimator.name, &estimator.effort})
      check_line(*text, "estimators");
  }
  const auto check_text = [](const std::string& text, const char* table) {
    if (FindNotPlain(text) != std::string::npos)
      throw Damage(fmt::format("table {} has a text with control characters: {}", table, Quoted(text)));
  };
  for (const std::string* text : {&run.description, &run.lock, &run.despite_lock}) check_text(*text, "run");
  for (const auto& [key, text] : run.ademp) check_text(text, "run");
  for (const DescribedEstimator& estimator : run.estimators) {
    for (const auto& [name, value] : estimator.options) check_text(name + value, "options");
  }
}

RunDescription ReadRun(SQLite::Database& database) {
  const RunValues values(database);
  RunDescription run;
  run.study = values.Text("name");
  run.description = values.Text("description");
  Ademp keys;
  for (const auto& [key, text] : Parts(keys)) {
    if (!values.Text("ademp_" + key).empty()) run.ademp.emplace_back(key, values.Text("ademp_" + key));
  }
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  run.seed = static_cast<std::uint64_t>(values.WholeNumber("seed", kMax));
  run.trials = static_cast<int>(values.WholeNumber("trials", std::numeric_limits<int>::max()));
  run.repeats_per_scene = static_cast<int>(values.WholeNumber("repeats_per_scene", kMaxRepeatsPerScene));
  if (run.repeats_per_scene == 0) throw Damage("'repeats_per_scene' of table run is not possible");
  run.failure = values.Failure();
  run.study_yaml = values.Text("study");
  run.identity = values.Text("identity");
  run.stopping_rule = values.Text("stopping_rule");
  run.until_options = values.Text("until_options");
  run.until_trials = values.WholeNumber("until_trials", kMax);
  if (values.Has("retried_trials"))
    run.retried_trials = values.WholeNumber("retried_trials", kMaxRetriedTrials);
  if (values.Has("lock")) run.lock = values.Text("lock");
  if (values.Has("despite_lock")) run.despite_lock = values.Text("despite_lock");
  run.shard = values.Text("shard");
  run.keeps_counts = values.Text("keep") == "counts";
  if (!run.keeps_counts && values.Text("keep") != "all") throw Damage("'keep' of table run is not possible");
  run.origin = {values.Text("program"), values.Text("instruction_set")};
  return run;
}

// Throws Damage unless the number in the first column is that of the row.
void CheckNumber(SQLite::Statement& row, const char* table, size_t number) {
  if (IntegerIn(row.getColumn(0), table) != static_cast<std::int64_t>(number))
    throw Damage(fmt::format("table {} lacks row {}", table, number));
}

// Calls `visit` for the rows of a table whose first column is the row's number.
template <typename Visit>
void ForEachNumbered(SQLite::Database& database, const char* table, Visit visit) {
  SQLite::Statement row(database, fmt::format("SELECT * FROM {} ORDER BY 1", table));
  for (size_t number = 0; row.executeStep(); ++number) {
    CheckNumber(row, table, number);
    visit(row);
  }
}

void ReadLevels(SQLite::Database& database, RunDescription* run) {
  SQLite::Statement row(database, "SELECT * FROM levels ORDER BY condition, factor");
  for (size_t c = 0; c < run->conditions.size(); ++c) {
    for (size_t f = 0; f < run->factors.size(); ++f) {
      if (!row.executeStep() || IntegerIn(row.getColumn(0), "levels") != static_cast<std::int64_t>(c) ||
          IntegerIn(row.getColumn(1), "levels") != static_cast<std::int64_t>(f))
        throw Damage(fmt::format("table levels lacks factor {} of condition {}", f, c));
      run->conditions[c].levels.push_back(TextIn(row.getColumn(2), "levels"));
    }
  }
  if (row.executeStep()) throw Damage("table levels has more rows than conditions and factors");
}

void ReadOptions(SQLite::Database& database, RunDescription* run) {
  SQLite::Statement row(database, "SELECT * FROM options ORDER BY estimator, name");
  while (row.executeStep()) {
    const std::int64_t estimator = IntegerIn(row.getColumn(0), "options");
    if (estimator < 0 || estimator >= std::ssize(run->estimators))
      throw Damage("table options has an estimator that there is not");
    run->estimators[static_cast<size_t>(estimator)].options.emplace_back(TextIn(row.getColumn(1), "options"),
                                                                         TextIn(row.getColumn(2), "options"));
  }
}

}  // namespace

RunDescription ReadDescription(SQLite::Database& database) {
  RunDescription run = ReadRun(database);
  if (UncheckedRunValue(database, kChecksum) != ChecksumOfRows(database))
    throw Damage("the checksum of the tables that describe the run is not theirs");
  ForEachNumbered(database, "factors", [&](SQLite::Statement& row) {
    run.factors.push_back(TextIn(row.getColumn(1), "factors"));
  });
  ForEachNumbered(database, "conditions", [&](SQLite::Statement& row) {
    const std::int64_t num_trials = IntegerIn(row.getColumn(1), "conditions");
    if (num_trials < 0 || num_trials > std::numeric_limits<int>::max())
      throw Damage("table conditions has a number of trials that is not possible");
    run.conditions.push_back({{}, num_trials});
  });
  ForEachNumbered(database, "estimators", [&](SQLite::Statement& row) {
    run.estimators.push_back({TextIn(row.getColumn(1), "estimators"),
                              TextIn(row.getColumn(2), "estimators"),
                              TextIn(row.getColumn(3), "estimators"),
                              {}});
  });
  ReadLevels(database, &run);
  ReadOptions(database, &run);
  CheckTexts(run);
  return run;
}

void WriteDescription(SQLite::Database& database, const RunDescription& run) {
  for (const std::string& table : DescriptionTables()) database.exec("DELETE FROM " + table);
  for (const auto& [key, value] : ListRunValues(run)) Insert(database, "run", key, value);
  const auto number = [](size_t index) { return static_cast<std::int64_t>(index); };
  for (size_t f = 0; f < run.factors.size(); ++f) Insert(database, "factors", number(f), run.factors[f]);
  for (size_t c = 0; c < run.conditions.size(); ++c) {
    Insert(database, "conditions", number(c), run.conditions[c].num_trials);
    for (size_t f = 0; f < run.factors.size(); ++f)
      Insert(database, "levels", number(c), number(f), run.conditions[c].levels[f]);
  }
  for (size_t e = 0; e < run.estimators.size(); ++e) {
    const DescribedEstimator& estimator = run.estimators[e];
    Insert(database, "estimators", number(e), estimator.label, estimator.name, estimator.effort);
    for (const auto& [name, value] : estimator.options) Insert(database, "options", number(e), name, value);
  }
  Insert(database, "run", std::string(kChecksum), ChecksumOfRows(database));
}

std::optional<std::string> SoundStoppingRule(SQLite::Database& database, const std::string& identity) {
  const std::string rule = UncheckedRunValue(database, "stopping_rule");
  const bool is_sound = UncheckedRunValue(database, kRuleChecksum) == ChecksumOfStoppingRule(identity, rule);
  return is_sound ? std::optional(rule) : std::nullopt;
}

std::string UncheckedRunValue(SQLite::Database& database, const std::string& key) {
  SQLite::Statement query(database, "SELECT value FROM run WHERE key = ?");
  query.bind(1, key);
  return query.executeStep() ? TextIn(query.getColumn(0), "run") : std::string();
}

}  // namespace rcme
