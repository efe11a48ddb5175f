// The tables of a result file: `run` (key, value), `conditions` (the level of each factor), `estimators`
// (labels), `totals` (per condition, how many trials there are and the sum of their checksums), `problems`
// and `trials` (the records).
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <string>
#include <vector>

namespace rcme {

inline constexpr const char* kResultFormat = "rcme results 4";  // `run` holds it as "format"

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
