// The tables of a result file, column by column. Their SQL, the check of a file and the page
// docs/result_file.md follow from this list.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <string>
#include <vector>

namespace rcme {

inline constexpr const char* kResultFormat = "rcme results 10";  // "format" in the table `run`

struct ResultColumn {
  std::string name, type;  // INTEGER, REAL or TEXT
  std::string unit;        // empty: no unit
  std::string meaning;
  bool may_be_null = false;  // NULL means not known
};

struct ResultTable {
  std::string name, meaning;
  std::vector<ResultColumn> columns;
  std::vector<std::string> key;  // columns that identify a row
};

// Returns the tables, in the order of the documentation.
const std::vector<ResultTable>& ResultTables();

// The rows of the table `run`; every file has all of them.
struct RunKey {
  std::string name, meaning;
};
const std::vector<RunKey>& RunKeys();

// Returns the tables that describe the run: all except totals, problems and trials.
const std::vector<std::string>& DescriptionTables();

void CreateTables(SQLite::Database& database);
void DropTables(SQLite::Database& database);

// Throws InputError if the file is not a result file or has another format.
void CheckFormat(SQLite::Database& database, const std::string& path);

// Throws Damage unless the file has exactly these tables: no column or type may differ, and there may be no
// further table, index, view or trigger.
void CheckSchema(SQLite::Database& database);

// The same for the given tables only; others are ignored.
void CheckTables(SQLite::Database& database, const std::vector<std::string>& names);

}  // namespace rcme
