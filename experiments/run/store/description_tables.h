// The description of a run in the tables of its result file.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <optional>
#include <string>

#include "experiments/study/run_description.h"

namespace rcme {

// Throws Damage: a row that is missing or not possible, or another checksum than that of the rows.
RunDescription ReadDescription(SQLite::Database& database);

// In the place of all rows that the tables have.
void WriteDescription(SQLite::Database& database, const RunDescription& run);

// One value of the table `run`, unchecked, for what can be saved; empty where there is none. Throws Damage.
std::string UncheckedRunValue(SQLite::Database& database, const std::string& key);

// What stopped the run, for what can be saved where the description is damaged elsewhere; nothing where this
// is damaged too, is of another study, or was not protected yet. Throws Damage.
std::optional<std::string> SoundStoppingRule(SQLite::Database& database, const std::string& identity);

}  // namespace rcme
