#include "experiments/statistics/count_study.h"

#include <fmt/format.h>

#include <chrono>
#include <mutex>
#include <utility>

#include "experiments/statistics/run_counts.h"
#include "experiments/core/text/message.h"
#include "experiments/core/work/progress.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/run/store/open_for_run.h"
#include "experiments/run/for_each_trial.h"
#include "experiments/run/refusal_watch.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kWriteInterval{10};

void CheckCanBeCounted(const StudyPlan& plan) {
  if (plan.study.repeats_per_scene > 1) {
    throw InputError(
        "--keep counts does not work with repeats_per_scene: "
        "counts cannot separate the variance between scenes from that within them");
  }
}

// The counts of a run that is under way. Any thread may call it.
class GrowingCounts {
 public:
  GrowingCounts(const StudyPlan& plan, const Shard& shard, ResultFile* file)
      : plan_(plan), shard_(shard), file_(file), counts_(ReadCounts(*file)) {
    counts_.run = file->description;
  }

  std::vector<TrialsOfCondition> Missing(std::int64_t* num_trials) const {
    std::vector<TrialsOfCondition> missing;
    for (const Condition& condition : plan_.conditions) {
      const ShardTrials trials(shard_, condition.index, 1);
      const std::uint32_t end = trials.NumBefore(static_cast<std::uint32_t>(condition.num_trials));
      *num_trials += end;
      const auto& places = counts_.conditions[condition.index].places;
      const auto found = places.find(shard_.Text());
      for (const TrialRange& range : (found == places.end() ? Places() : found->second).Missing(end))
        missing.push_back({&condition, range, trials});
    }
    return missing;
  }

  void Add(const TrialResult& result) {
    const ProblemRecord& problem = result.problem;
    if (problem.weight != 1.0)
      throw InputError("--keep counts: the trials of this study are weighted (tilted_to)");
    const std::lock_guard lock(mutex_);
    ConditionCounts& condition = counts_.conditions[problem.condition];
    condition.cell.Add(problem, result.records, counts_.run.failure);
    condition.places[shard_.Text()].Add(ShardTrials(shard_, problem.condition, 1).NumBefore(problem.trial));
    condition.kept.Add({problem, result.records, 0}, counts_.run.failure);
    changed_.insert(problem.condition);
    ++num_added_;
    if (Clock::now() >= next_write_) Write();
  }

  void Flush() {
    const std::lock_guard lock(mutex_);
    Write();
  }
  std::int64_t num_added() const { return num_added_; }

 private:
  void Write() {
    NamingFile(file_->path, [&] { WriteCounts(counts_, std::exchange(changed_, {}), file_); });
    next_write_ = Clock::now() + kWriteInterval;
  }

  const StudyPlan& plan_;
  const Shard shard_;
  ResultFile* file_;
  std::mutex mutex_;  // of what follows
  RunCounts counts_;
  std::set<std::uint32_t> changed_;
  std::int64_t num_added_ = 0;
  Clock::time_point next_write_ = Clock::now() + kWriteInterval;
};

void NoteOrigin(ResultFile* file) {
  RunDescription run = file->description;
  const std::string warning = NoteOriginIn(&run, file->path, file->totals.NumTrials() > 0, ThisProgram());
  if (run.origin != file->description.origin) file->SetDescription(run);
  if (!warning.empty()) PrintMessage("warning: {}\n", warning);
}

}  // namespace

RunReport CountStudy(const StudyPlan& plan, int num_threads, const std::string& path, const Shard& shard) {
  CheckCanBeCounted(plan);
  const Clock::time_point start = Clock::now();
  return NamingFile(path, [&] {
    const std::unique_ptr<ResultFile> file = OpenFileForRun(path, plan, shard, Keep::kCounts);
    GrowingCounts counts(plan, shard, file.get());
    std::int64_t num_trials = 0;
    const std::vector<TrialsOfCondition> missing = counts.Missing(&num_trials);
    const std::int64_t num_to_run = NumTrials(missing), num_before = num_trials - num_to_run;
    if (num_to_run > 0) {
      CheckProcessEstimators(plan.study.estimators);
      NoteOrigin(file.get());
    }
    RefusalWatch refusals;
    Progress progress("trials", num_trials, num_before);
    try {
      ForEachTrial(missing, num_threads, &progress,
                   [&](const Condition& condition, std::uint32_t trial, std::int64_t) {
                     const TrialResult result = RunTrial(plan, condition, trial);
                     counts.Add(result);
                     refusals.Add(result.records);
                   });
    } catch (const Stopped&) {
      counts.Flush();
      throw Stopped(fmt::format("stopped, {} trials counted; the same command resumes",
                                num_before + counts.num_added()));
    } catch (...) {
      counts.Flush();  // the trials before the error are good
      throw;
    }
    counts.Flush();
    refusals.WarnOfRefusals(plan.study.estimators);
    const std::chrono::duration<double> elapsed = Clock::now() - start;
    return RunReport{num_trials, num_to_run, elapsed.count()};
  });
}

}  // namespace rcme
