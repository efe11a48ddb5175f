// The tables of a run that keeps counts instead of trials (docs/result_file.md), as texts.
// statistics/summary_cell.h interprets them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/run/store/result_file.h"

namespace rcme {

struct CountedPlaces {
  std::string shard, places;

  bool operator==(const CountedPlaces&) const = default;
};

struct CountedQuantity {
  std::uint32_t estimator = 0;
  std::string quantity;
  std::int64_t n = 0;
  std::string sum, sum_squares, cells;

  bool operator==(const CountedQuantity&) const = default;
};

// The counts of one condition.
struct StoredCounts {
  std::vector<CountedPlaces> places;        // by shard
  std::vector<CountedQuantity> quantities;  // by estimator and quantity

  bool operator==(const StoredCounts&) const = default;
};

// Reads the counts of every condition. Throws Damage.
std::vector<StoredCounts> ReadStoredCounts(const ResultFile& file);

// Replaces the counts of a condition in the file, within a transaction of the caller.
void WriteStoredCounts(ResultFile* file, std::uint32_t condition, const StoredCounts& counts);

}  // namespace rcme
