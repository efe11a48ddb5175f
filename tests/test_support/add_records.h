// Records of estimators with the records of their problems, which most tests do not care about.
#pragma once

#include "experiments/run/store/result_store.h"

namespace rcme {

// Adds the records with one problem for each (condition, trial) among them; whole trials, one after the
// other.
inline void AddRecords(ResultStore& store, const std::vector<TrialRecord>& records) {
  std::vector<ProblemRecord> problems;
  for (const TrialRecord& record : records) {
    const bool is_new = problems.empty() || problems.back().condition != record.condition ||
                        problems.back().trial != record.trial;
    if (!is_new) continue;
    problems.emplace_back();
    problems.back().condition = record.condition;
    problems.back().trial = record.trial;
  }
  store.Add(problems, records);
}

}  // namespace rcme
