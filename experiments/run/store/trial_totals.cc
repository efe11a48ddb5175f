#include "experiments/run/store/trial_totals.h"

#include <fmt/format.h>

#include "experiments/core/files/database.h"

namespace rcme {

TrialTotals TrialTotals::Read(SQLite::Database& database) {
  TrialTotals totals;
  SQLite::Statement query(database, "SELECT * FROM totals ORDER BY condition");
  while (query.executeStep()) {
    const std::int64_t condition = IntegerIn(query.getColumn(0), "totals");
    if (condition != static_cast<std::int64_t>(totals.totals_.size()))
      throw Damage(fmt::format("table totals lacks condition {}", totals.totals_.size()));
    const std::int64_t num_trials = IntegerIn(query.getColumn(1), "totals");
    if (num_trials < 0 || num_trials > kMaxTrialsOfCondition) ThrowOutOfRange(query.getColumn(1), "totals");
    totals.totals_.push_back({num_trials, IntegerIn(query.getColumn(2), "totals")});
  }
  return totals;
}

TrialTotals TrialTotals::Write(SQLite::Database& database, size_t num_conditions) {
  TrialTotals totals;
  totals.totals_.resize(num_conditions);
  SQLite::Statement insert(database, "INSERT INTO totals VALUES (?, ?, ?)");
  for (size_t c = 0; c < num_conditions; ++c) Execute(insert, static_cast<std::int64_t>(c), 0, 0);
  return totals;
}

std::int64_t TrialTotals::NumTrials() const {
  std::int64_t sum = 0;
  for (const TrialTotal& total : totals_) sum += total.num_trials;
  return sum;
}

void TrialTotals::Add(std::uint32_t condition, std::uint32_t trial_checksum) {
  totals_.at(condition).Add(trial_checksum);
  changed_.insert(condition);
}

void TrialTotals::Remove(std::uint32_t condition, std::uint32_t trial_checksum) {
  TrialTotal& total = totals_.at(condition);
  --total.num_trials;
  total.checksum -= trial_checksum;
  changed_.insert(condition);
}

void TrialTotals::Clear(std::uint32_t condition) {
  totals_.at(condition) = {};
  changed_.insert(condition);
}

void TrialTotals::WriteChanged(SQLite::Database& database) {
  SQLite::Statement insert(database, "INSERT OR REPLACE INTO totals VALUES (?, ?, ?)");
  for (const std::uint32_t condition : changed_)
    Execute(insert, condition, totals_[condition].num_trials, totals_[condition].checksum);
  changed_.clear();
}

}  // namespace rcme
