// Opens and reads SQLite files that are not trusted. Errors become messages for the user.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>

#include <cstdint>
#include <string>

#include "experiments/core/files/damage.h"

namespace rcme {

// Opens a database without running its views, triggers or functions; SQL cannot write its internal tables.
// `flags` are those of SQLite. Throws SQLite::Exception.
enum class FileLocks { kUsed, kNone };  // kNone: for file systems without locks, if nobody writes
SQLite::Database OpenDatabase(const std::string& path, int flags, FileLocks locks = FileLocks::kUsed);

// Translate a database error or damage into an InputError that names the file.
[[noreturn]] void ThrowForFile(const std::string& path, const SQLite::Exception& error);
[[noreturn]] void ThrowForFile(const std::string& path, const Damage& damage);

// Runs `action` and translates its errors by ThrowForFile.
template <typename Action>
auto NamingFile(const std::string& path, Action action) {
  try {
    return action();
  } catch (const SQLite::Exception& error) {
    ThrowForFile(path, error);
  } catch (const Damage& damage) {
    ThrowForFile(path, damage);
  }
}

// The value of a column of the current row. Throws Damage if it is stored as another type.
std::string TextIn(const SQLite::Column& column, const char* table);
std::int64_t IntegerIn(const SQLite::Column& column, const char* table);

// Runs a statement without result with these parameters.
template <typename... Values>
void Execute(SQLite::Statement& statement, const Values&... values) {
  SQLite::bind(statement, values...);
  statement.exec();
  statement.reset();
}

[[noreturn]] void ThrowWrongType(const SQLite::Column& column, const char* table, const char* wanted);
[[noreturn]] void ThrowOutOfRange(const SQLite::Column& column, const char* table);

}  // namespace rcme
