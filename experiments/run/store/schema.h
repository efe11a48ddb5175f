// The tables of a result file, column by column: their SQL, their page in the documents (docs/result_file.md)
// and what is checked of a file all follow from this one list.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <string>
#include <vector>

namespace rcme {

inline constexpr const char* kResultFormat = "rcme results 10";  // `run` holds it as "format"

struct ResultColumn {
  std::string name, type;  // INTEGER, REAL or TEXT
  std::string unit;        // empty: none
  std::string meaning;
  bool may_be_null = false;  // not known
};

struct ResultTable {
  std::string name, meaning;
  std::vector<ResultColumn> columns;
  std::vector<std::string> key;  // the columns that tell rows apart
};

// In the order in which a reader wants them.
const std::vector<ResultTable>& ResultTables();

// The rows of the table `run`, which every file has, all of them.
struct RunKey {
  std::string name, meaning;
};
const std::vector<RunKey>& RunKeys();

// The tables that describe the run: all but the totals, problems and trials.
const std::vector<std::string>& DescriptionTables();

void CreateTables(SQLite::Database& database);
void DropTables(SQLite::Database& database);

// Throws InputError if the file is not a result file, or of another format.
void CheckFormat(SQLite::Database& database, const std::string& path);

// Throws Damage if the file does not have exactly our tables: a column or its type differs, there is a
// further table, an index, a view or a trigger.
void CheckSchema(SQLite::Database& database);

// The same for these tables alone, whatever else there is.
void CheckTables(SQLite::Database& database, const std::vector<std::string>& names);

}  // namespace rcme
