// The description of a run in the tables of its result file.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <string>

#include "experiments/study/run_description.h"

namespace rcme {

// Throws Damage: a row that is missing or not possible, or another checksum than that of the rows.
RunDescription ReadDescription(SQLite::Database& database);

// In the place of all rows that the tables have.
void WriteDescription(SQLite::Database& database, const RunDescription& run);

// One value of the table `run`, unchecked, for what can be saved; empty where there is none. Throws Damage.
std::string UncheckedRunValue(SQLite::Database& database, const std::string& key);

}  // namespace rcme
