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
  columns.push_back(
      {"checksum", "INTEGER", "", "CRC-32 of the study's identity, the problem and its trials"});
  return columns;
}

}  // namespace

const std::vector<ResultTable>& ResultTables() {
  static const std::vector<ResultTable> tables = {
      {"run",
       "The run as a whole, a row for each key of the list below.",
       {{"key", "TEXT", "", "one of the keys below"}, {"value", "TEXT", "", "its value as text"}},
       {"key"}},
      {"factors",
       "The factors of the study. A folder of real pairs adds `pair_scene` as the last one.",
       {{"factor", "INTEGER", "", "number of the factor, from 0"},
        {"name", "TEXT", "", "the data key that it varies; its name includes the unit"}},
       {"factor"}},
      {"conditions",
       "The conditions of the study, each a combination of levels.",
       {KeyColumn(kConditionColumn),
        {"num_trials", "INTEGER", "trials", "the most trials that any run requested"}},
       {"condition"}},
      {"levels",
       "The level of every factor in every condition.",
       {KeyColumn(kConditionColumn),
        {"factor", "INTEGER", "", "number of the factor, from 0"},
        {"level", "TEXT", "of the factor", "its level, as in the study"}},
       {"condition", "factor"}},
      {"estimators",
       "The estimators of the study.",
       {KeyColumn(kEstimatorColumn),
        {"label", "TEXT", "", "its name in tables and figures; unique"},
        {"name", "TEXT", "", "its name in `rcme list estimators`"},
        {"effort", "TEXT", "", "the limit of a call's work, in words; empty: unknown"}},
       {"estimator"}},
      {"options",
       "Every option of every estimator, including defaults.",
       {KeyColumn(kEstimatorColumn),
        {"name", "TEXT", "", "name of the option"},
        {"value", "TEXT", "of the option", "its value as text"}},
       {"estimator", "name"}},
      {"totals",
       "The trials in the file per condition, written together with them, so that a loss is noticed.",
       {KeyColumn(kConditionColumn),
        {"num_trials", "INTEGER", "trials", "trials in the file"},
        {"checksum", "INTEGER", "", "sum of their checksums"}},
       {"condition"}},
      {"counted",
       "The trials that the counts cover; empty unless the run keeps counts.",
       {KeyColumn(kConditionColumn),
        {"shard", "TEXT", "", "their shard, such as `3/64`; empty: all trials"},
        {"places", "TEXT", "", "their places in the shard, from 0: `0-499,600`"},
        {"checksum", "INTEGER", "", "CRC-32 of the study's identity and the row"}},
       {"condition", "shard"}},
      {"counts",
       "The exact sums that the summary needs; empty unless the run keeps counts. A sum is a hexadecimal "
       "whole number and a power of two, `-1a3p-20`.",
       {KeyColumn(kConditionColumn),
        {"estimator", "INTEGER", "", "number of the estimator; the number after the last: the problems"},
        {"quantity", "TEXT", "", "its name (`rcme list quantities`)"},
        {"n", "INTEGER", "trials", "trials with a value"},
        {"sum", "TEXT", "of the quantity", "sum of the values, decimal for a rate; empty for a median"},
        {"sum_squares", "TEXT", "", "sum of their squares; empty for a rate and a median"},
        {"cells", "TEXT", "",
         "median: count, least and greatest value of each cell (`stats/stream_median.h`); score: its parts "
         "on a grid (`stats/exact_scores.h`); otherwise empty"},
        {"checksum", "INTEGER", "", "CRC-32 of the study's identity and the row"}},
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
      {"format", "the format of the file"},
      {"name", "the name of the study"},
      {"description", "the study's description"},
      {"ademp_aims", "the study's aims; this and the next four are empty without an ADEMP block"},
      {"ademp_data", "how its data are made"},
      {"ademp_estimands", "what is estimated"},
      {"ademp_methods", "what is compared"},
      {"ademp_performance", "what is measured"},
      {"seed", "the seed of all random streams"},
      {"trials", "requested trials per condition; for a folder of real pairs, passes over each pair"},
      {"repeats_per_scene", "consecutive trials of each scene: trial k has scene k / repeats_per_scene"},
      {"max_rotation_error_deg", "failure bound: a motion with a greater rotation error has failed"},
      {"max_direction_error_deg", "failure bound: a motion with a greater error of the direction has failed"},
      {"stopping_rule", "how the number of trials depended on their outcomes; empty: it did not"},
      {"stopping_rule_checksum",
       "CRC-32 of identity and stopping_rule: the kind of interval is known even if other rows are damaged"},
      {"until_options", "the options of `rcme run --until` if these alone made the trials; otherwise empty"},
      {"until_trials", "the number of trials that they made in all conditions"},
      {"retried_trials",
       "number of repeated trials (`rcme run --retry`), each time counted; a file of an earlier version has "
       "no such row"},
      {"lock",
       "the lock file of the run (`rcme lock`), with the locked study and its SHA-256; empty: none; a file "
       "of an earlier version has neither this row nor the next"},
      {"despite_lock",
       "why the study departs from its lock (`rcme run --despite-lock`), one reason per line"},
      {"shard",
       "the shards in the file: `3/64`, or the complete ones of a merged file, `1-3,7/64` or `none/64`; "
       "empty: the whole study"},
      {"keep", "`all`: every trial; `counts`: the sums that the summary needs, and a few trials"},
      {"program", "programs that computed trials, with versions, separated by commas; empty: unknown"},
      {"instruction_set", "instruction sets that they used, likewise"},
      {"study", "the study in full (YAML), for `rcme run`, `rcme replay` and `rcme show`"},
      {"identity", "what runs must have in common to share a file: study, seed, digest of real data"},
      {"checksum",
       "CRC-32 of all rows of the tables "
       "run, factors, conditions, levels, estimators and options but this one"}};
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
