#include "experiments/statistics/count_study.h"

#include <fmt/format.h>

#include <chrono>
#include <mutex>
#include <utility>

#include "experiments/run/store/open_for_run.h"
#include "experiments/statistics/run_counts.h"
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

// The counts of the current run.
class CountsKeeper : public TrialKeeper {
 public:
  CountsKeeper(const Shard& shard, ResultFile* file)
      : shard_(shard), file_(file), counts_(ReadCounts(*file)) {}

  std::vector<TrialRange> MissingTrials(std::uint32_t condition, std::uint32_t num_trials,
                                        const ShardTrials& shard) override {
    return counts_.conditions[condition].FindPlaces(shard_.Text()).Missing(shard.NumBefore(num_trials));
  }

  std::string NoteOrigin(const TrialOrigin& origin) override {
    RunDescription run = file_->description;
    const std::string warning = NoteOriginIn(&run, file_->path, file_->totals.NumTrials() > 0, origin);
    if (run.origin != file_->description.origin) file_->SetDescription(run);
    return warning;
  }

  void Keep(const TrialResult& result) override {
    const ProblemRecord& problem = result.problem;
    if (problem.weight != 1.0)
      throw InputError("--keep counts: the trials of this study are weighted (tilted_to)");
    const std::lock_guard lock(mutex_);
    ConditionCounts& condition = counts_.conditions[problem.condition];
    condition.cell.Add(problem, result.records, counts_.run.failure);
    condition.places[shard_.Text()].Add(ShardTrials(shard_, problem.condition, 1).NumBefore(problem.trial));
    condition.kept.Add({problem, result.records, 0}, counts_.run.failure);
    changed_.insert(problem.condition);
    if (Clock::now() >= next_write_) Write();
  }

  void Flush() override {
    const std::lock_guard lock(mutex_);
    Write();
  }
  std::string DescribeKept(std::int64_t num_done) const override {
    return fmt::format("stopped, {} trials counted; the same command resumes", num_done);
  }

 private:
  void Write() {
    NamingFile(file_->path, [&] { WriteCounts(counts_, std::exchange(changed_, {}), file_); });
    next_write_ = Clock::now() + kWriteInterval;
  }

  const Shard shard_;
  ResultFile* file_;
  std::mutex mutex_;  // guards the members below
  RunCounts counts_;
  std::set<std::uint32_t> changed_;
  Clock::time_point next_write_ = Clock::now() + kWriteInterval;
};

}  // namespace

RunReport CountStudy(const StudyPlan& plan, int num_threads, const std::string& path, const Shard& shard) {
  CheckCanBeCounted(plan);
  return NamingFile(path, [&] {
    const std::unique_ptr<ResultFile> file = OpenFileForRun(path, plan, shard, Keep::kCounts);
    CountsKeeper counts(shard, file.get());
    return RunTrials(plan, shard, num_threads, &counts);
  });
}

}  // namespace rcme
