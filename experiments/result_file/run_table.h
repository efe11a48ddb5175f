// What a result file says of its run beside the trials: the tables `run`, `conditions` and `estimators`.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <map>
#include <string>

#include "experiments/study/study_plan.h"

namespace rcme {

class RunTable {
 public:
  // Reads the three tables. Throws Damage if their checksum, which `run` holds as "checksum", is not theirs.
  static RunTable Read(SQLite::Database& database);
  // The table `run` as it stands, for what can be saved from it.
  static RunTable ReadUnchecked(SQLite::Database& database);
  // Writes them for a plan; the tables are empty.
  static RunTable Write(SQLite::Database& database, const StudyPlan& plan);

  // Empty where there is no such key.
  std::string Value(const std::string& key) const;
  void Set(SQLite::Database& database, const std::map<std::string, std::string>& values);

  size_t num_estimators() const { return num_estimators_; }

 private:
  std::map<std::string, std::string> values_;
  size_t num_estimators_ = 0;
};

}  // namespace rcme
