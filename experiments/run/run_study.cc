#include "experiments/run/run_study.h"

#include <fmt/format.h>

#include <chrono>
#include <mutex>

namespace rcme {
namespace {

using Clock = std::chrono::steady_clock;

// Collects the records of finished trials. From time to time one thread writes them while the others go on.
class RecordBuffer : public TrialKeeper {
 public:
  explicit RecordBuffer(ResultStore* store) : store_(store) {}

  std::vector<TrialRange> MissingTrials(std::uint32_t condition, std::uint32_t num_trials,
                                        const ShardTrials& shard) override {
    return store_->MissingTrials(condition, num_trials, shard);
  }
  std::string NoteOrigin(const TrialOrigin& origin) override { return store_->NoteOrigin(origin); }

  std::string RecordFile() const override { return store_->path(); }

  void Keep(const TrialResult& result) override {
    const Clock::time_point now = Clock::now();
    size_t num_waiting = 0;
    {
      const std::lock_guard lock(waiting_mutex_);
      waiting_.problems.push_back(result.problem);
      waiting_.trials.insert(waiting_.trials.end(), result.records.begin(), result.records.end());
      num_waiting = waiting_.trials.size();
      if (now < next_write_ && num_waiting < kMaxWaiting) return;
    }
    std::unique_lock writing(writing_mutex_, std::try_to_lock);
    if (!writing && num_waiting < kMaxWaiting) return;  // another thread writes
    if (!writing) writing.lock();                       // the other thread is not fast enough
    Write();
  }

  void Flush() override {
    const std::lock_guard writing(writing_mutex_);
    Write();
    store_->Commit();
  }
  std::string DescribeKept(std::int64_t num_done) const override {
    return fmt::format("stopped, {} trials kept; the same command resumes", num_done);
  }

 private:
  static constexpr std::chrono::milliseconds kWriteInterval{50};
  static constexpr size_t kMaxWaiting = 4'000;

  void Write() {
    {
      const std::lock_guard lock(waiting_mutex_);
      written_.problems.clear();
      written_.trials.clear();
      std::swap(written_, waiting_);
      next_write_ = Clock::now() + kWriteInterval;
    }
    store_->Add(written_.problems, written_.trials);
  }

  struct Records {
    std::vector<ProblemRecord> problems;
    std::vector<TrialRecord> trials;
  };

  ResultStore* store_;
  std::mutex waiting_mutex_;  // guards waiting_ and next_write_
  Records waiting_;
  Clock::time_point next_write_ = Clock::now() + kWriteInterval;
  std::mutex writing_mutex_;  // guards written_
  Records written_;
};

}  // namespace

RunReport RunStudy(const StudyPlan& plan, int num_threads, ResultStore* store, const Shard& shard) {
  RecordBuffer buffer(store);
  return RunTrials(plan, shard, num_threads, &buffer);
}

}  // namespace rcme
