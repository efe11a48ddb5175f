#include "experiments/run/store/trial_reader.h"

#include <fmt/format.h>

#include <utility>

#include "experiments/core/files/database.h"
#include "experiments/core/work/read_ahead.h"
#include "experiments/run/store/record_table.h"
#include "experiments/run/store/trial_checksum.h"

namespace rcme {
namespace {

using TrialKey = std::pair<std::uint32_t, std::uint32_t>;  // condition, trial

[[noreturn]] void ThrowDamagedTrial(const TrialKey& key, const std::string& what) {
  throw Damage(fmt::format("condition {}, trial {}: {}", key.first, key.second, what));
}

// Assembles trials from their rows, in order.
class TrialRows {
 public:
  TrialRows(const SQLite::Database& database, const TrialFrame& frame, const std::string& where)
      : frame_(frame),
        problems_(database, SelectFromRecordTable<ProblemRecord>(where)),
        records_(database, SelectFromRecordTable<TrialRecord>(where)) {}

  // Returns false after the last trial. Throws Damage.
  bool Next() {
    if (!problems_.executeStep()) {
      CheckNoneIsLeft();
      return false;
    }
    trial_.problem = ReadRecord<ProblemRecord>(problems_);
    const TrialKey key{trial_.problem.condition, trial_.problem.trial};
    if (previous_ && key <= *previous_) ThrowDamagedTrial(key, "is out of order");
    if (key.first >= frame_.num_conditions) ThrowDamagedTrial(key, "the study has no such condition");
    previous_ = key;
    ReadRecords(key);
    CheckChecksum(key);
    return true;
  }
  const StoredTrial& trial() const { return trial_; }

 private:
  void ReadRecords(const TrialKey& key) {
    trial_.records.clear();
    for (size_t e = 0; e < frame_.num_estimators; ++e) {
      if (!records_.executeStep()) ThrowDamagedTrial(key, fmt::format("has no record of estimator {}", e));
      trial_.records.push_back(ReadTrialRecord(key));
      const TrialRecord& record = trial_.records.back();
      if (TrialKey{record.condition, record.trial} != key || record.estimator != e) {
        ThrowDamagedTrial(key, fmt::format("has no record of estimator {}, or others are in its place", e));
      }
    }
  }

  TrialRecord ReadTrialRecord(const TrialKey& key) {
    try {
      return ReadRecord<TrialRecord>(records_);
    } catch (const Damage& damage) {
      ThrowDamagedTrial(key, damage.what());
    }
  }

  void CheckChecksum(const TrialKey& key) {
    const std::int64_t stored = IntegerIn(problems_.getColumn(problems_.getColumnCount() - 1), "problems");
    trial_.checksum = ChecksumOfTrial(frame_.identity, trial_.problem, trial_.records);
    if (stored != std::int64_t{trial_.checksum}) ThrowDamagedTrial(key, "its checksum is another");
  }

  void CheckNoneIsLeft() {
    if (!records_.executeStep()) return;
    const TrialRecord record = ReadRecord<TrialRecord>(records_);
    ThrowDamagedTrial({record.condition, record.trial}, "has more records than estimators");
  }

  const TrialFrame frame_;
  SQLite::Statement problems_, records_;
  StoredTrial trial_;
  std::optional<TrialKey> previous_;
};

}  // namespace

void ForEachStoredTrial(const SQLite::Database& database, const TrialFrame& frame,
                        std::optional<std::uint32_t> condition,
                        const std::function<void(const StoredTrial&)>& visit) {
  TrialRows rows(database, frame, condition ? fmt::format(" WHERE condition = {}", *condition) : "");
  if (condition) {  // few trials: a thread does not pay
    while (rows.Next()) visit(rows.trial());
    return;
  }
  const auto read = [&](StoredTrial* trial) {
    if (!rows.Next()) return false;
    *trial = rows.trial();
    return true;
  };
  ReadAhead<StoredTrial>(read, visit);
}

std::optional<StoredTrial> ReadStoredTrial(const SQLite::Database& database, const TrialFrame& frame,
                                           std::uint32_t condition, std::uint32_t trial) {
  TrialRows rows(database, frame, fmt::format(" WHERE condition = {} AND trial = {}", condition, trial));
  if (!rows.Next()) return std::nullopt;
  const StoredTrial found = rows.trial();
  rows.Next();  // throws if there are further rows
  return found;
}

}  // namespace rcme
