// The description of a run in the tables of its result file.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <optional>
#include <string>

#include "experiments/study/run_description.h"

namespace rcme {

// Throws Damage if a row is missing or impossible, or if the checksum does not match the rows.
RunDescription ReadDescription(SQLite::Database& database);

// Replaces all rows of the tables.
void WriteDescription(SQLite::Database& database, const RunDescription& run);

// Returns one unchecked value of the table `run`, for recovery; empty if there is none. Throws Damage.
std::string UncheckedRunValue(SQLite::Database& database, const std::string& key);

// Returns the stopping rule of the run, for recovery when the description is damaged elsewhere. Nothing if
// the rule is damaged too, is of another study, or has no checksum because the file is older. Throws Damage.
std::optional<std::string> SoundStoppingRule(SQLite::Database& database, const std::string& identity);

}  // namespace rcme
