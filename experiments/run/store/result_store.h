// The raw trials of one run in an SQLite file, which is kept; summaries are made from it whenever needed.
// docs/result_file.md describes its tables.
//
// Opening a file checks its tables and the description of the run. Trials and the totals of their conditions
// are checked as they are read, so no command uses a damaged file unnoticed. Damage is an InputError; `rcme
// check` (salvage.h) gives details.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/core/work/shard.h"
#include "experiments/study/run_description.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial.h"
#include "experiments/trial/trial_range.h"

namespace rcme {

// Returns the origin of trials that this program computes.
TrialOrigin ThisProgram();

// Not thread-safe.
class ResultStore {
 public:
  // Opens the file of this plan's study, or makes it. If an earlier run planned more trials, they stay
  // planned. Throws InputError if the path cannot be written, is not a result file or a damaged one, is in
  // use by another run, or holds another study (the message says what differs) or another shard.
  static ResultStore OpenForRun(const std::string& path, const StudyPlan& plan, const Shard& shard = {});
  // Opens an existing file for reading, without a pass over its trials. Throws InputError if it is not a
  // result file or its description is damaged.
  static ResultStore OpenForReading(const std::string& path);

  ResultStore(ResultStore&&) noexcept;
  ~ResultStore();  // commits added trials

  const std::string& path() const;

  // Returns the description of the run. A condition's number of trials is the planned one; under a stopping
  // rule, the number in the file. The options of --until are present only if they alone produce the trials
  // in the file.
  RunDescription Description() const;
  // Returns the study in the file. Its commands may come from anybody (study/command_permission.h).
  Study StoredStudy() const;
  // Makes the stored study ready to run, which is needed to compute its trials again, not to read them.
  // Throws InputError if its data (a folder of pairs) are missing or have changed, or if a command has not
  // been allowed. Under a stopping rule it checks all trials, because only they confirm their number.
  StudyPlan Plan(const Study& stored, PlanEstimators estimators = PlanEstimators::kMade) const;
  StudyPlan Plan() const { return Plan(StoredStudy()); }

  // Returns which of the first `num_trials` trials of a condition belong to the shard and are missing in the
  // file, as ascending places in the shard. Checks all trials of a file opened for reading.
  std::vector<TrialRange> MissingTrials(std::uint32_t condition, std::uint32_t num_trials,
                                        const ShardTrials& shard = {});

  // The number of trials of all conditions.
  std::int64_t NumTrials() const;

  // Adds whole trials: for each problem one record per estimator, in the order of the problems. They are on
  // disk within about half a second, either all records of a call or none. Throws InputError if a trial
  // exists already, std::logic_error if it is incomplete or not of the study.
  void Add(const std::vector<ProblemRecord>& problems, const std::vector<TrialRecord>& records);
  // Writes all added trials to disk.
  void Commit();

  // Removes the trials in which an answer has one of these statuses, so that they are run again, and notes
  // their number (RunDescription::retried_trials). Returns it; writes nothing if it is 0.
  std::int64_t RemoveForRetry(const std::vector<MotionStatus>& statuses);

  // Notes permanently that the number of trials may depend on their outcomes (run_until.h), so intervals for
  // a single look do not hold. Call this before the first trial of such a run.
  void NoteStoppingRule(const std::string& rule);
  // Notes the options with which a single `rcme run` computes exactly the trials in the file, `num_trials`
  // in all.
  void NoteUntilOptions(const std::string& options, std::int64_t num_trials);

  // Notes the origin of the trials to be added. Returns a warning if trials in the file come from another
  // program or instruction set, else an empty text.
  std::string NoteOrigin(const TrialOrigin& origin);

  // Checks all trials by reading them, unless this has been done. Call it before you write output if you
  // read trials later: the functions below throw InputError at the first damaged trial, or at the end if
  // trials are lost.
  void CheckTrials() const;

  // Calls `visit` for every record, ordered by condition, trial and estimator, in constant memory.
  void ForEachRecord(const std::function<void(const TrialRecord&)>& visit) const;
  // Calls `visit` for every trial, ordered by condition and trial, with its records ordered by estimator;
  // optionally only for one condition. Reads on a thread of its own, so `visit` must not call this store.
  void ForEachTrial(const std::function<void(const ProblemRecord&, const std::vector<TrialRecord>&)>& visit,
                    std::optional<std::uint32_t> condition = std::nullopt) const;
  // Returns the records of one trial, ordered by estimator. If there are none, it checks all trials, so that
  // a lost trial is not mistaken for one that was never run.
  std::vector<TrialRecord> ReadTrialRecords(std::uint32_t condition, std::uint32_t trial) const;

 private:
  struct Connection;
  void Set(const RunDescription& run);
  explicit ResultStore(std::unique_ptr<Connection> connection);
  std::unique_ptr<Connection> connection_;
};

}  // namespace rcme
