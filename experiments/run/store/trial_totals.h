// The number and checksum of the trials of each condition, in the table `totals`. They are written together
// with the trials, so lost or foreign trials are noticed.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <set>
#include <vector>

namespace rcme {

inline constexpr std::int64_t kMaxTrialsOfCondition = std::int64_t{1} << 32;  // trial numbers have 32 bits

struct TrialTotal {
  std::int64_t num_trials = 0;
  std::int64_t checksum = 0;  // sum of the trials' checksums, independent of their order

  void Add(std::uint32_t trial_checksum) {
    ++num_trials;
    checksum += trial_checksum;
  }
  bool operator==(const TrialTotal&) const = default;
};

class TrialTotals {
 public:
  // Throws Damage if the rows are not those of conditions 0, 1, 2, ...
  static TrialTotals Read(SQLite::Database& database);
  // Writes a row of zeros for each condition into the empty table.
  static TrialTotals Write(SQLite::Database& database, size_t num_conditions);

  size_t num_conditions() const { return totals_.size(); }
  const TrialTotal& Of(size_t condition) const { return totals_[condition]; }
  std::int64_t NumTrials() const;

  void Add(std::uint32_t condition, std::uint32_t trial_checksum);
  void Remove(std::uint32_t condition, std::uint32_t trial_checksum);
  void Clear(std::uint32_t condition);
  // Writes the rows that have changed since the last call.
  void WriteChanged(SQLite::Database& database);

 private:
  std::vector<TrialTotal> totals_;
  std::set<std::uint32_t> changed_;
};

}  // namespace rcme
