#include "experiments/core/work/stop_request.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <thread>

#include "experiments/core/work/for_each_index.h"
#include "experiments/run/run_study.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"
#include "tests/test_support/test_estimators.h"

namespace rcme {
namespace {

// A shell's job in the background ignores the interrupt, and so would the tests that are started there.
class StopRequest : public testing::Test {
 protected:
  StopRequest() : before_(std::signal(SIGINT, SIG_DFL)) {}
  ~StopRequest() override { std::signal(SIGINT, before_); }

 private:
  void (*before_)(int);
};

TEST_F(StopRequest, WorkEndsBetweenOnePieceAndTheNext) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const StopOnSignals stop;
    std::atomic<int> num_begun = 0, num_ended = 0;
    const auto work = [&](std::int64_t) {
      if (++num_begun == 10) std::raise(signal);
      ++num_ended;
    };
    EXPECT_THROW(ForEachIndex(1'000'000, 2, work), Stopped);
    EXPECT_GE(num_begun, 10);
    EXPECT_EQ(num_ended, num_begun) << "what was begun is finished";
    EXPECT_EQ(StopExitCode(), 128 + signal);
  }
}

TEST_F(StopRequest, ThatComesWithTheLastPieceStopsNothing) {
  const StopOnSignals stop;
  int num_done = 0;
  ForEachIndex(10, 1, [&](std::int64_t i) {
    if (i == 9) std::raise(SIGINT);
    ++num_done;
  });
  EXPECT_EQ(num_done, 10);
  EXPECT_TRUE(IsStopRequested());
}

TEST_F(StopRequest, IsForgottenByTheNextAndTheHandlersAreGivenBack) {
  {
    const StopOnSignals stop;
    std::raise(SIGINT);
    EXPECT_TRUE(IsStopRequested());
  }
  const StopOnSignals next;
  EXPECT_FALSE(IsStopRequested());
  std::signal(SIGTERM, SIG_IGN);
  {
    const StopOnSignals under_nohup;
    std::raise(SIGTERM);
    EXPECT_FALSE(IsStopRequested()) << "what was ignored stays so";
  }
  std::signal(SIGTERM, SIG_DFL);
}

TEST_F(StopRequest, TheSignalAfterTheLastRequestEndsTheProgram) {
  for (const int num_requests : {1, 2}) {
    const auto raise_times = [&](int times) {
      const StopOnSignals stop(num_requests);
      for (int i = 0; i < times; ++i) std::raise(SIGINT);
      std::_Exit(IsStopRequested() ? 7 : 0);
    };
    EXPECT_EXIT(raise_times(num_requests), testing::ExitedWithCode(7), "");
    EXPECT_EXIT(raise_times(num_requests + 1), testing::KilledBySignal(SIGINT), "");
  }
}

TEST_F(StopRequest, ComesByItselfAfterATimeAndAsksToTryAgain) {
  {
    const StopOnSignals stop;
    StopAfter(std::chrono::milliseconds(20));
    EXPECT_FALSE(IsStopRequested());
    EXPECT_THROW(ForEachIndex(1'000'000'000, 2, [](std::int64_t) {}), Stopped);
    EXPECT_EQ(StopExitCode(), 75);
    std::raise(SIGTERM);
    EXPECT_EQ(StopExitCode(), 128 + SIGTERM) << "who was asked to end says so";
  }
  {
    const StopOnSignals stop;
    StopAfter(std::chrono::milliseconds(1));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  EXPECT_NO_THROW(ForEachIndex(10, 1, [](std::int64_t) {})) << "the limit ends with who set it";
  const StopOnSignals next;
  EXPECT_FALSE(IsStopRequested());
}

// The run is stopped by a signal in the call of its fifth motion, whatever the machine does meanwhile.
TEST_F(StopRequest, ARunKeepsItsTrialsAndGoesOnLater) {
  const StudyPlan plan = MakePlan(SmallStudy());
  StudyPlan interrupted = plan;
  std::atomic<int> num_calls = 0;
  interrupted.estimators[0] = std::make_shared<FaultyEstimator>([&](MotionEstimate&) {
    if (++num_calls == 5) std::raise(SIGINT);
  });
  interrupted.estimators[1] = interrupted.estimators[0];
  const TempFolder folder;
  ResultStore store = ResultStore::OpenForRun(folder.Path("run.sqlite"), plan);
  const auto count = [&] {
    int trials = 0;
    store.ForEachRecord([&](const TrialRecord& record) { trials += record.estimator == 0; });
    return trials;
  };
  {
    const StopOnSignals stop;
    try {
      RunStudy(interrupted, 2, &store);
      FAIL() << "not stopped";
    } catch (const Stopped& stopped) {
      EXPECT_EQ(stopped.what(), fmt::format("stopped, {} trials kept; the same command resumes", count()));
    }
  }
  const int num_kept = count();
  EXPECT_GE(num_kept, 1);
  EXPECT_LT(num_kept, plan.NumTrials());
  const StopOnSignals stop;
  const RunReport report = RunStudy(plan, 2, &store);
  EXPECT_EQ(report.num_run_now, plan.NumTrials() - num_kept);
  EXPECT_EQ(count(), plan.NumTrials());
}

}  // namespace
}  // namespace rcme
