#include "experiments/result_file/run_table.h"

#include <fmt/format.h>

#include "experiments/result_file/checksum.h"
#include "experiments/result_file/database.h"
#include "experiments/result_file/schema.h"

namespace rcme {
namespace {

constexpr const char* kChecksum = "checksum";

// Every row but the checksum's, column by column.
std::vector<std::string> Contents(SQLite::Database& database) {
  std::vector<std::string> texts;
  SQLite::Statement run(database, "SELECT key, value FROM run WHERE key <> 'checksum' ORDER BY key");
  while (run.executeStep()) {
    for (int c = 0; c < 2; ++c) texts.push_back(TextIn(run.getColumn(c), "run"));
  }
  SQLite::Statement conditions(database, "SELECT * FROM conditions ORDER BY condition, factor");
  while (conditions.executeStep()) {
    texts.push_back(std::to_string(IntegerIn(conditions.getColumn(0), "conditions")));
    for (int c = 1; c < 3; ++c) texts.push_back(TextIn(conditions.getColumn(c), "conditions"));
  }
  SQLite::Statement estimators(database, "SELECT * FROM estimators ORDER BY estimator");
  while (estimators.executeStep()) {
    texts.push_back(std::to_string(IntegerIn(estimators.getColumn(0), "estimators")));
    texts.push_back(TextIn(estimators.getColumn(1), "estimators"));
  }
  return texts;
}

std::string ChecksumText(SQLite::Database& database) {
  return fmt::format("{:08x}", ChecksumOf(Contents(database)));
}

template <typename... Values>
void Insert(SQLite::Database& database, const char* sql, const Values&... values) {
  SQLite::Statement statement(database, sql);
  int parameter = 1;
  (statement.bind(parameter++, values), ...);
  statement.exec();
}

}  // namespace

RunTable RunTable::ReadUnchecked(SQLite::Database& database) {
  RunTable table;
  SQLite::Statement query(database, "SELECT key, value FROM run ORDER BY key");
  while (query.executeStep()) {
    table.values_[TextIn(query.getColumn(0), "run")] = TextIn(query.getColumn(1), "run");
  }
  return table;
}

RunTable RunTable::Read(SQLite::Database& database) {
  RunTable table = ReadUnchecked(database);
  table.num_estimators_ = database.execAndGet("SELECT count(*) FROM estimators").getUInt();
  if (table.Value(kChecksum) != ChecksumText(database))
    throw Damage("the checksum of the tables run, conditions and estimators is not theirs");
  return table;
}

RunTable RunTable::Write(SQLite::Database& database, const StudyPlan& plan) {
  for (const Condition& condition : plan.conditions) {
    for (size_t f = 0; f < plan.factor_names.size(); ++f) {
      Insert(database, "INSERT INTO conditions VALUES (?, ?, ?)", static_cast<std::int64_t>(condition.index),
             plan.factor_names[f], condition.levels[f]);
    }
  }
  for (size_t e = 0; e < plan.study.estimators.size(); ++e) {
    Insert(database, "INSERT INTO estimators VALUES (?, ?)", static_cast<std::int64_t>(e),
           plan.study.estimators[e].label);
  }
  RunTable table;
  table.num_estimators_ = plan.study.estimators.size();
  table.Set(database, {{"format", kResultFormat}, {"identity", plan.identity}, {"study", plan.study_yaml}});
  return table;
}

std::string RunTable::Value(const std::string& key) const {
  const auto found = values_.find(key);
  return found == values_.end() ? std::string() : found->second;
}

void RunTable::Set(SQLite::Database& database, const std::map<std::string, std::string>& values) {
  const auto put = [&](const std::string& key, const std::string& value) {
    Insert(database, "INSERT OR REPLACE INTO run VALUES (?, ?)", key, value);
    values_[key] = value;
  };
  for (const auto& [key, value] : values) put(key, value);
  put(kChecksum, ChecksumText(database));
}

}  // namespace rcme
