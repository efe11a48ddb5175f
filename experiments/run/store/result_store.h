// The raw trials of one run in one SQLite file, kept for good: summaries are made from them later, again and
// again. docs/result_file.md has its tables.
//
// Opening a file checks its tables and what describes the run; a trial and its condition's total are checked
// as they are read, so that no command takes a damaged file for a sound one. Damage is an InputError;
// `rcme check` (salvage.h) says more.
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

// Of the trials that this program computes.
TrialOrigin ThisProgram();

// One thread at a time may call it.
class ResultStore {
 public:
  // Opens the file of this plan's study, or makes it; what earlier runs asked for is still asked for: the
  // study keeps the greatest number of trials. Throws InputError if the path cannot be written, is no result
  // file or a damaged one, is in use by another run, or holds another study (the message says what differs)
  // or another shard of it.
  static ResultStore OpenForRun(const std::string& path, const StudyPlan& plan, const Shard& shard = {});
  // Opens an existing file to read, without a pass over its trials. Throws InputError if it is not a result
  // file, or what describes its run is damaged.
  static ResultStore OpenForReading(const std::string& path);

  ResultStore(ResultStore&&) noexcept;
  ~ResultStore();  // commits what has been added

  // What the file says of its run. A condition's trials are those that runs asked for, under a stopping rule
  // those that it took; the options of --until are there as long as they alone give the trials in the file.
  RunDescription Description() const;
  // The study in the file. Whoever made the file may have put commands into it (study/command_permission.h).
  Study StoredStudy() const;
  // That study made ready to run: needed to compute its trials again, not to read them. Throws InputError if
  // its data (a folder of pairs) are gone or have changed, or for a command that nobody has allowed. Under a
  // stopping rule the trials alone confirm how many there are: all are checked.
  StudyPlan Plan(const Study& stored, PlanEstimators estimators = PlanEstimators::kMade) const;
  StudyPlan Plan() const { return Plan(StoredStudy()); }

  // Those of the first `num_trials` trials of a condition that the shard has and the file lacks, by their
  // place in the shard, ascending. Checks all trials of a file that is read.
  std::vector<TrialRange> MissingTrials(std::uint32_t condition, std::uint32_t num_trials,
                                        const ShardTrials& shard = {});

  // Of all conditions.
  std::int64_t NumTrials() const;

  // Adds whole trials, to each problem one record per estimator, in the problems' order; they reach the disk
  // within about half a second, all records of a call or none. Throws InputError if a trial is there already,
  // std::logic_error if it is not whole or not of the study.
  void Add(const std::vector<ProblemRecord>& problems, const std::vector<TrialRecord>& records);
  // Writes what has been added.
  void Commit();

  // Takes out the trials in which an answer was missing in one of these ways, so that they are missing and
  // run again, and notes their number (RunDescription::retried_trials), which it returns. Nothing is written
  // where it is 0.
  std::int64_t RemoveForRetry(const std::vector<MotionStatus>& statuses);

  // How many trials a condition has may depend on their outcomes (run_until.h). Noted before the first trial
  // of such a run and for good: intervals that look once no longer hold.
  void NoteStoppingRule(const std::string& rule);
  // Options of `rcme run` that alone give the trials in the file, `num_trials` in all.
  void NoteUntilOptions(const std::string& options, std::int64_t num_trials);

  // Noted before trials are added. Returns a sentence of warning if trials in the file are of another program
  // or instruction set, else nothing.
  std::string NoteOrigin(const TrialOrigin& origin);

  // Reads all trials and so checks them, unless that has been done. Call this before you write anything while
  // trials are still to be read: the functions below throw InputError at the first trial that is not sound,
  // or at the end where trials are lost.
  void CheckTrials() const;

  // Calls `visit` for every record, ordered by condition, trial, estimator. Constant memory.
  void ForEachRecord(const std::function<void(const TrialRecord&)>& visit) const;
  // Calls `visit` for every trial, ordered by condition and trial; its records are ordered by estimator. Only
  // the trials of one condition, if it is given. Reads on a thread of its own: `visit` calls no function of
  // this store.
  void ForEachTrial(const std::function<void(const ProblemRecord&, const std::vector<TrialRecord>&)>& visit,
                    std::optional<std::uint32_t> condition = std::nullopt) const;
  // The records of one trial, ordered by estimator. Where there is none all trials are checked, so that a
  // lost one is not taken for one that was never run.
  std::vector<TrialRecord> ReadTrialRecords(std::uint32_t condition, std::uint32_t trial) const;

 private:
  struct Connection;
  void Set(const RunDescription& run);
  explicit ResultStore(std::unique_ptr<Connection> connection);
  std::unique_ptr<Connection> connection_;
};

}  // namespace rcme
