#include "experiments/run/store/trial_writer.h"

#include <stdexcept>

#include "experiments/run/store/record_table.h"
#include "experiments/run/store/trial_checksum.h"

namespace rcme {
namespace {

constexpr std::chrono::milliseconds kCommitInterval{500};

}  // namespace

TrialWriter::TrialWriter(ResultFile* file)
    : file_(file),
      frame_(file->Frame()),
      insert_problem_(file->database, InsertIntoRecordTable<ProblemRecord>()),
      insert_trial_(file->database, InsertIntoRecordTable<TrialRecord>()) {}

template <typename Action>
void TrialWriter::OrRollBack(Action action) {
  try {
    action();
  } catch (...) {
    insert_problem_.tryReset();
    insert_trial_.tryReset();
    transaction_.reset();
    file_->totals = TrialTotals::Read(file_->database);
    throw;
  }
}

void TrialWriter::AddTrial(const ProblemRecord& problem, std::span<const TrialRecord> records) {
  if (problem.condition >= frame_.num_conditions) throw std::logic_error("a trial of no condition");
  for (size_t e = 0; e < records.size(); ++e) {
    const TrialRecord& record = records[e];
    if (record.condition != problem.condition || record.trial != problem.trial || record.estimator != e)
      throw std::logic_error("the records are not those of the problem");
    BindFields(insert_trial_, record);
    Execute(insert_trial_);
  }
  const std::uint32_t checksum = ChecksumOfTrial(frame_.identity, problem, records);
  insert_problem_.bind(BindFields(insert_problem_, problem), checksum);
  Execute(insert_problem_);
  file_->totals.Add(problem.condition, checksum);
}

void TrialWriter::Add(const std::vector<ProblemRecord>& problems, const std::vector<TrialRecord>& records) {
  if (records.size() != problems.size() * frame_.num_estimators)
    throw std::logic_error("a trial has one record per estimator");
  if (!transaction_) transaction_.emplace(file_->database);
  OrRollBack([&] {
    std::span<const TrialRecord> rest(records);
    for (const ProblemRecord& problem : problems) {
      AddTrial(problem, rest.first(frame_.num_estimators));
      rest = rest.subspan(frame_.num_estimators);
    }
  });
  if (Clock::now() - last_commit_ > kCommitInterval) Commit();
}

void TrialWriter::Commit() {
  if (!transaction_) return;
  OrRollBack([&] {
    file_->totals.WriteChanged(file_->database);
    transaction_->commit();
  });
  transaction_.reset();
  last_commit_ = Clock::now();
}

}  // namespace rcme
