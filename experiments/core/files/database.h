// A connection to an untrusted SQLite file; its errors are sentences.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <string>

#include "experiments/core/files/damage.h"

namespace rcme {

// No views, triggers or functions of the file are run, and its internal tables cannot be written by SQL.
// `flags` are SQLite's. Throws SQLite::Exception.
enum class FileLocks { kUsed, kNone };  // none: for file systems without; who opens knows that nobody writes
SQLite::Database OpenDatabase(const std::string& path, int flags, FileLocks locks = FileLocks::kUsed);

// Throws what an error of the database or damage means to the user: an InputError that names the file.
[[noreturn]] void ThrowForFile(const std::string& path, const SQLite::Exception& error);
[[noreturn]] void ThrowForFile(const std::string& path, const Damage& damage);

// Runs `action`, and turns its errors into those.
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

[[noreturn]] void ThrowWrongType(const SQLite::Column& column, const char* table, const char* wanted);
[[noreturn]] void ThrowOutOfRange(const SQLite::Column& column, const char* table);

}  // namespace rcme
