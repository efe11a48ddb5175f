#include "experiments/result_file/schema.h"

#include <fmt/format.h>

#include <map>
#include <string>

#include "experiments/result_file/database.h"
#include "experiments/result_file/record_table.h"

namespace rcme {
namespace {

// The SQL of each table, word for word as the file keeps it.
const std::map<std::string, std::string>& Tables() {
  static const std::map<std::string, std::string> tables = {
      {"run", "CREATE TABLE run (key TEXT NOT NULL PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID"},
      {"conditions",
       "CREATE TABLE conditions (condition INTEGER NOT NULL, factor TEXT NOT NULL, level TEXT NOT NULL, "
       "PRIMARY KEY (condition, factor)) WITHOUT ROWID"},
      {"estimators", "CREATE TABLE estimators (estimator INTEGER PRIMARY KEY, label TEXT NOT NULL)"},
      {"totals",
       "CREATE TABLE totals (condition INTEGER PRIMARY KEY, num_trials INTEGER NOT NULL, checksum INTEGER "
       "NOT "
       "NULL)"},
      {"problems", CreateRecordTable<ProblemRecord>()},
      {"trials", CreateRecordTable<TrialRecord>()}};
  return tables;
}

std::string FormatIn(SQLite::Database& database) {
  if (!database.tableExists("run")) return {};
  SQLite::Statement query(database, "SELECT value FROM run WHERE key = 'format'");
  return query.executeStep() && query.getColumn(0).isText() ? query.getColumn(0).getString() : std::string();
}

// "table trials", "view problems", ... with its SQL.
std::map<std::string, std::string> SchemaOf(SQLite::Database& database) {
  std::map<std::string, std::string> entries;
  SQLite::Statement query(database, "SELECT type, name, sql FROM sqlite_schema");
  while (query.executeStep()) {
    entries[query.getColumn(0).getString() + " " + query.getColumn(1).getString()] =
        query.getColumn(2).getString();
  }
  return entries;
}

}  // namespace

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
  const std::map<std::string, std::string> entries = SchemaOf(database);
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
  for (const auto& [entry, sql] : SchemaOf(database)) {
    const bool is_ours = entry.starts_with("table ") && Tables().contains(entry.substr(6));
    if (!is_ours) throw Damage(fmt::format("it holds a {}, which rcme does not make", entry));
  }
}

}  // namespace rcme
