// A run that keeps counts in place of its trials: what is counted of every condition, and a few trials as
// they are, in memory and in a result file.
//
// Kept as they are: kNumSampled trials of each condition, and kNumFailed of those in which a motion has
// failed, those of the least hashes. So they are a random sample that is the same whatever shards the trials
// came in.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "experiments/core/work/shard.h"
#include "experiments/run/store/result_file.h"
#include "experiments/statistics/summary_cell.h"

namespace rcme {

// Places of trials in a shard.
class Places {
 public:
  static Places First(std::uint32_t num);

  void Add(std::uint32_t place);
  void AddAll(const Places& other);
  bool Intersects(const Places& other) const;
  bool Has(std::uint32_t place) const { return place < has_.size() && has_[place]; }
  std::int64_t num() const { return num_; }
  // Those of 0, ..., end - 1 that are not there, ascending.
  std::vector<TrialRange> Missing(std::uint32_t end) const;

  // "0-499,600".
  std::string Text() const;
  // Throws Damage.
  static Places FromText(const std::string& text);

 private:
  std::vector<bool> has_;
  std::int64_t num_ = 0;
};

class KeptTrials {
 public:
  static constexpr size_t kNumSampled = 20, kNumFailed = 100;

  void Add(const StoredTrial& trial, const FailureBounds& bounds);
  // By number.
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

// Throws Damage, and InputError if the file keeps its trials.
RunCounts ReadCounts(const ResultFile& file);

// Writes the conditions in one transaction in place of what the file has of them.
void WriteCounts(const RunCounts& counts, const std::set<std::uint32_t>& conditions, ResultFile* file);

}  // namespace rcme
