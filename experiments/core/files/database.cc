#include "experiments/core/files/database.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <filesystem>

namespace rcme {
namespace {

constexpr int kBusyTimeoutMs = 1000;
constexpr int kMaxValueBytes = 64 << 20;  // of a text or blob, so that a small file cannot fill the memory

std::string TypeName(const SQLite::Column& column) {
  if (column.isNull()) return "NULL";
  if (column.isText()) return "text";
  if (column.isBlob()) return "bytes";
  return column.isInteger() ? "a whole number" : "a real number";
}

// Describes an error of a result file; the text follows "PATH: ".
std::string DescribeFileError(const SQLite::Exception& error) {
  switch (error.getErrorCode()) {
    case SQLITE_NOTADB:
      return "is not an rcme result file, or is damaged at its beginning";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "is in use by another run (or on a file system without locks)";
    case SQLITE_FULL:
    case SQLITE_IOERR:
      return fmt::format("cannot be written ({}); trials committed before are safe", error.what());
    case SQLITE_READONLY:
      if (error.getExtendedErrorCode() == SQLITE_READONLY_ROLLBACK)
        return "its run was killed in the middle of a write; the same `rcme run` resumes it";
      return fmt::format("cannot be opened for writing ({})", error.what());
    case SQLITE_CANTOPEN:
      return fmt::format("cannot be opened ({})", error.what());
    default:
      return error.what();
  }
}

}  // namespace

SQLite::Database OpenDatabase(const std::string& path, int flags, FileLocks locks) {
  // The absolute path is needed because SQLite gives '', ':memory:' and 'file:...' a meaning of their own.
  // SQLite's mutexes are off, as they cost a tenth of an insertion and a store has one caller at a time.
  SQLite::Database database(std::filesystem::absolute(path).string(), flags | SQLite::OPEN_NOMUTEX,
                            kBusyTimeoutMs, locks == FileLocks::kUsed ? "" : "unix-none");
  sqlite3_db_config(database.getHandle(), SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(database.getHandle(), SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database.getHandle(), SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(database.getHandle(), SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_limit(database.getHandle(), SQLITE_LIMIT_LENGTH, kMaxValueBytes);
  database.exec("PRAGMA cell_size_check = ON");
  return database;
}

void ThrowForFile(const std::string& path, const SQLite::Exception& error) {
  if (error.getErrorCode() == SQLITE_CORRUPT) ThrowForFile(path, Damage(error.what()));
  if (error.getErrorCode() == SQLITE_TOOBIG)
    ThrowForFile(path, Damage(fmt::format("a value of more than {} MiB", kMaxValueBytes >> 20)));
  throw InputError(fmt::format("{}: {}", path, DescribeFileError(error)));
}

void ThrowForFile(const std::string& path, const Damage& damage) {
  throw DamagedFileError(
      fmt::format("{}: is damaged: {}; `rcme check {}` says what can be saved", path, damage.what(), path));
}

void ThrowWrongType(const SQLite::Column& column, const char* table, const char* wanted) {
  throw Damage(
      fmt::format("{} of table {} is {}, not {}", column.getName(), table, TypeName(column), wanted));
}

void ThrowOutOfRange(const SQLite::Column& column, const char* table) {
  const std::string text = column.getString();
  throw Damage(fmt::format("{} of table {} is {}, which is not possible", column.getName(), table,
                           text.size() > 40 ? "a long text" : "'" + text + "'"));
}

std::string TextIn(const SQLite::Column& column, const char* table) {
  if (!column.isText()) ThrowWrongType(column, table, "text");
  return column.getString();
}

std::int64_t IntegerIn(const SQLite::Column& column, const char* table) {
  if (!column.isInteger()) ThrowWrongType(column, table, "a whole number");
  return column.getInt64();
}

}  // namespace rcme
