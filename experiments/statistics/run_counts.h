// A run that keeps counts instead of its trials, in memory and in a result file: the counts of every
// condition, and a few whole trials.
//
// Of each condition it keeps kNumSampled trials, and kNumFailed of those in which a motion failed: the
// trials with the least hashes. They are therefore a random sample that does not depend on the shards.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "experiments/run/store/places.h"
#include "experiments/run/store/result_file.h"
#include "experiments/statistics/summary_cell.h"

namespace rcme {

class KeptTrials {
 public:
  static constexpr size_t kNumSampled = 20, kNumFailed = 100;

  void Add(const StoredTrial& trial, const FailureBounds& bounds);
  // Returns the kept trials by number.
  std::map<std::uint32_t, StoredTrial> All() const;

 private:
  std::map<std::uint64_t, StoredTrial> sampled_, failed_;  // by hash
};

struct ConditionCounts {
  explicit ConditionCounts(size_t num_estimators) : cell(num_estimators) {}

  SummaryCell cell;
  std::map<std::string, Places> places;  // by shard, as Shard::Text
  KeptTrials kept;

  const Places& FindPlaces(const std::string& shard) const;
};

struct RunCounts {
  RunDescription run;
  std::vector<ConditionCounts> conditions;

  explicit RunCounts(const RunDescription& description);
  std::int64_t NumTrials() const;
};

// Throws Damage, and InputError if the file keeps trials.
RunCounts ReadCounts(const ResultFile& file);

// Replaces these conditions in the file, in one transaction.
void WriteCounts(const RunCounts& counts, const std::set<std::uint32_t>& conditions, ResultFile* file);

}  // namespace rcme
