// The tables of a run that keeps counts in place of trials (docs/result_file.md), as texts: what they mean is
// known to statistics/summary_cell.h.
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

// Of one condition.
struct StoredCounts {
  std::vector<CountedPlaces> places;        // by shard
  std::vector<CountedQuantity> quantities;  // by estimator and quantity

  bool operator==(const StoredCounts&) const = default;
};

// Every condition of the file. Throws Damage.
std::vector<StoredCounts> ReadStoredCounts(const ResultFile& file);

// In the place of what the file has of the condition, in a transaction of the caller's.
void WriteStoredCounts(ResultFile* file, std::uint32_t condition, const StoredCounts& counts);

}  // namespace rcme
