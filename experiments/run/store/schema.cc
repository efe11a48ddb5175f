#include "experiments/run/store/schema.h"

#include <fmt/format.h>

#include <map>
#include <string>

#include "experiments/run/store/record_table.h"

namespace rcme {
namespace {

// Returns the SQL of each table, exactly as the file stores it.
const std::map<std::string, std::string>& Tables() {
  static const std::map<std::string, std::string> tables = [] {
    std::map<std::string, std::string> sql;
    for (const ResultTable& table : ResultTables()) {
      std::string columns;
      for (const ResultColumn& column : table.columns)
        columns += fmt::format("{} {}{}, ", column.name, column.type, column.may_be_null ? "" : " NOT NULL");
      sql[table.name] = fmt::format("CREATE TABLE {} ({}PRIMARY KEY ({})) WITHOUT ROWID", table.name, columns,
                                    fmt::join(table.key, ", "));
    }
    return sql;
  }();
  return tables;
}

std::string FormatIn(SQLite::Database& database) {
  if (!database.tableExists("run")) return {};
  SQLite::Statement query(database, "SELECT value FROM run WHERE key = 'format'");
  return query.executeStep() && query.getColumn(0).isText() ? query.getColumn(0).getString() : std::string();
}

// Returns the SQL of each entry of the file, by kind and name: "table trials", "view problems".
std::map<std::string, std::string> ReadSchema(SQLite::Database& database) {
  std::map<std::string, std::string> entries;
  SQLite::Statement query(database, "SELECT type, name, sql FROM sqlite_schema");
  while (query.executeStep()) {
    entries[query.getColumn(0).getString() + " " + query.getColumn(1).getString()] =
        query.getColumn(2).getString();
  }
  return entries;
}

// A key column of integers, described as in the tables of trials.
ResultColumn KeyColumn(const StoredColumn& column) {
  return {column.name, "INTEGER", column.unit, column.meaning};
}

std::vector<ResultColumn> ProblemColumns() {
  std::vector<ResultColumn> columns = RecordColumns<ProblemRecord>();
  columns.push_back({"checksum", "INTEGER", "", "CRC-32 of identity, problem and its trials"});
  return columns;
}

}  // namespace

const std::vector<ResultTable>& ResultTables() {
  static const std::vector<ResultTable> tables = {
      {"run",
       "One row per key of the list below.",
       {{"key", "TEXT", "", "one of the keys below"}, {"value", "TEXT", "", "value as text"}},
       {"key"}},
      {"factors",
       "The factors of the study; match files add `pair_scene`.",
       {{"factor", "INTEGER", "", "number, from 0"}, {"name", "TEXT", "", "the data key"}},
       {"factor"}},
      {"conditions",
       "One row per condition.",
       {KeyColumn(kConditionColumn), {"num_trials", "INTEGER", "trials", "most trials that a run requested"}},
       {"condition"}},
      {"levels",
       "One row per factor of a condition.",
       {KeyColumn(kConditionColumn),
        {"factor", "INTEGER", "", "number, from 0"},
        {"level", "TEXT", "of the factor", "as in the study"}},
       {"condition", "factor"}},
      {"estimators",
       "One row per estimator.",
       {KeyColumn(kEstimatorColumn),
        {"label", "TEXT", "", "unique name in tables and figures"},
        {"name", "TEXT", "", "name in `rcme list estimators`"},
        {"effort", "TEXT", "", "limit of a call's work, in words; empty: unknown"}},
       {"estimator"}},
      {"options",
       "One row per option of an estimator, defaults included.",
       {KeyColumn(kEstimatorColumn),
        {"name", "TEXT", "", "name of the option"},
        {"value", "TEXT", "of the option", "value as text"}},
       {"estimator", "name"}},
      {"totals",
       "The trials per condition, to detect a loss.",
       {KeyColumn(kConditionColumn),
        {"num_trials", "INTEGER", "trials", "trials in the file"},
        {"checksum", "INTEGER", "", "sum of their checksums"}},
       {"condition"}},
      {"counted",
       "The trials that the counts cover, if the run keeps counts.",
       {KeyColumn(kConditionColumn),
        {"shard", "TEXT", "", "such as `3/64`; empty: all trials"},
        {"places", "TEXT", "", "places in the shard, from 0: `0-499,600`"},
        {"checksum", "INTEGER", "", "CRC-32 of identity and row"}},
       {"condition", "shard"}},
      {"counts",
       "The exact sums of the summary, if the run keeps counts: hexadecimal whole numbers with a "
       "power of two, `-1a3p-20`.",
       {KeyColumn(kConditionColumn),
        {"estimator", "INTEGER", "", "number of the estimator; after the last: the problems"},
        {"quantity", "TEXT", "", "name in `rcme list quantities`"},
        {"n", "INTEGER", "trials", "trials with a value"},
        {"sum", "TEXT", "of the quantity", "decimal for a rate; empty for a median"},
        {"sum_squares", "TEXT", "", "empty for a rate and a median"},
        {"cells", "TEXT", "",
         "median: count, least and greatest value per cell (`stats/stream_median.h`); score: parts on "
         "a grid (`stats/exact_scores.h`); else empty"},
        {"checksum", "INTEGER", "", "CRC-32 of identity and row"}},
       {"condition", "estimator", "quantity"}},
      {"problems", "One row per trial: its problem.", ProblemColumns(), {"condition", "trial"}},
      {"trials",
       "One row per trial and estimator: the answer.",
       RecordColumns<TrialRecord>(),
       {"condition", "trial", "estimator"}}};
  return tables;
}

const std::vector<RunKey>& RunKeys() {
  static const std::vector<RunKey> keys = {
      {"format", "of the file"},
      {"name", "of the study"},
      {"description", "of the study"},
      {"ademp_aims", "the study's aims; empty without an ADEMP block, as the next four"},
      {"ademp_data", "how its data are made"},
      {"ademp_estimands", "what is estimated"},
      {"ademp_methods", "what is compared"},
      {"ademp_performance", "what is measured"},
      {"seed", "seed of all random streams"},
      {"trials", "requested trials per condition; with match files, passes over each pair"},
      {"repeats_per_scene", "trial k has scene k / repeats_per_scene"},
      {"max_rotation_error_deg", "failure bound"},
      {"max_direction_error_deg", "failure bound"},
      {"stopping_rule", "how the number of trials depended on outcomes; empty: it did not"},
      {"stopping_rule_checksum", "CRC-32 of identity and stopping_rule"},
      {"until_options", "options of `rcme run --until` if these alone made the trials; else empty"},
      {"until_trials", "number of trials that they made"},
      {"retried_trials", "number of repetitions of trials (`rcme run --retry`); missing in older files"},
      {"lock",
       "lock file (`rcme lock`) with the locked study and its SHA-256; empty: none; missing in "
       "older files, as the next"},
      {"despite_lock", "departures from the lock (`rcme run --despite-lock`), a reason per line"},
      {"shard",
       "shards in the file: `3/64`; the complete ones of a merged file, `1-3,7/64` or `none/64`; "
       "empty: the whole study"},
      {"keep", "`all`: every trial; `counts`: sums and a few trials"},
      {"program", "programs that computed trials, with versions, by commas; empty: unknown"},
      {"instruction_set", "their instruction sets, likewise"},
      {"study", "the study in full (YAML)"},
      {"identity", "common to runs that share a file: study, seed, digest of real data"},
      {"checksum", "CRC-32 of all other rows of run, factors, conditions, levels, estimators and options"}};
  return keys;
}

const std::vector<std::string>& DescriptionTables() {
  static const std::vector<std::string> names = {"run",    "factors",    "conditions",
                                                 "levels", "estimators", "options"};
  return names;
}

void CreateTables(SQLite::Database& database) {
  for (const auto& [name, sql] : Tables()) database.exec(sql);
}

void DropTables(SQLite::Database& database) {
  for (const auto& [name, sql] : Tables()) database.exec("DROP TABLE " + name);
}

void CheckFormat(SQLite::Database& database, const std::string& path) {
  const std::string format = FormatIn(database);
  if (format == kResultFormat) return;
  if (format.starts_with("rcme results ")) {
    throw InputError(
        fmt::format("{}: was written by another version of rcme ('{}'; this one reads '{}'): run "
                    "its study again, into another file",
                    path, format, kResultFormat));
  }
  throw InputError(fmt::format("{}: is not an rcme result file ({})", path, kResultFormat));
}

void CheckTables(SQLite::Database& database, const std::vector<std::string>& names) {
  const std::map<std::string, std::string> entries = ReadSchema(database);
  for (const std::string& name : names) {
    const auto found = entries.find("table " + name);
    if (found == entries.end()) throw Damage(fmt::format("table {} is missing", name));
    if (found->second != Tables().at(name))
      throw Damage(fmt::format("table {} has other columns than rcme gives it", name));
  }
}

void CheckSchema(SQLite::Database& database) {
  std::vector<std::string> names;
  for (const auto& [name, sql] : Tables()) names.push_back(name);
  CheckTables(database, names);
  for (const auto& [entry, sql] : ReadSchema(database)) {
    const bool is_ours = entry.starts_with("table ") && Tables().contains(entry.substr(6));
    if (!is_ours) throw Damage(fmt::format("it holds a {}, which rcme does not make", entry));
  }
}

}  // namespace rcme
