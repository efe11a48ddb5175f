// The effort for a stated time, found for an estimator whose time is known.
#include "experiments/run/find_effort.h"

#include <gtest/gtest.h>

#include <memory>

#include "estimator/estimator_registry.h"
#include "experiments/core/work/thread_time.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

// Works for `rounds` times 20 us, at most `own_limit` rounds.
class BusyEstimator : public MotionEstimator {
 public:
  BusyEstimator(int rounds, int own_limit) : rounds_(std::min(rounds, own_limit)) {}
  MotionEstimate Estimate(const MotionProblem&, RandomStream&) const override {
    const double end = ThreadSeconds() + 20e-6 * rounds_;
    while (ThreadSeconds() < end) {
    }
    return {};
  }

 private:
  int rounds_;
};

class BusyModel : public EstimatorModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Integer("rounds", &rounds_, {1, 1000}, "how long"),
            Parameter::Integer("own_limit", &own_limit_, {1, 1e6}, "where its own rule stops")};
  }
  std::optional<Effort> EffortOption() const override { return Effort{"rounds", own_limit_ < 1000000}; }
  std::unique_ptr<MotionEstimator> Make() const override {
    return std::make_unique<BusyEstimator>(rounds_, own_limit_);
  }

 private:
  int rounds_ = 3, own_limit_ = 1000000;
};

EstimatorSpec Busy(const Settings& options = {}) {
  static const bool is_added = [] {
    AddEstimator({"busy", "works for a stated time", [] { return std::make_unique<BusyModel>(); }});
    return true;
  }();
  EXPECT_TRUE(is_added);
  EstimatorSpec spec = DefaultEstimator("busy");
  SetOptions(&spec, options);
  return spec;
}

std::vector<TimedProblem> SomeProblems() { return TimedProblems(MakePlan(SmallStudy()), 0, 5); }

TEST(FindEffort, FindsTheEffortOfATime) {
  for (const double time_ms : {1.0, 3.0, 8.0}) {
    const FoundEffort found = FindEffort(Busy(), SomeProblems(), time_ms);
    EXPECT_EQ(found.end, EffortEnd::kReached);
    EXPECT_NEAR(static_cast<double>(found.effort), 50.0 * time_ms, 0.1 * 50.0 * time_ms) << time_ms;
    EXPECT_EQ(found.spec.budget_ms, time_ms);
  }
}

TEST(FindEffort, SaysWhyATimeIsNotReached) {
  const FoundEffort slow = FindEffort(Busy(), SomeProblems(), 0.005);
  EXPECT_EQ(slow.end, EffortEnd::kTooSlow);
  EXPECT_EQ(slow.effort, 1);
  EXPECT_FALSE(slow.spec.budget_ms.has_value());
  EXPECT_EQ(FindEffort(Busy({{"own_limit", "10"}}), SomeProblems(), 2.0).end, EffortEnd::kOwnRule);
  EXPECT_EQ(FindEffort(Busy(), SomeProblems(), 100.0).end, EffortEnd::kAtTheLimit);
}

TEST(Effort, IsDescribed) {
  EXPECT_EQ(DescribeEffort(DefaultEstimator("standard")), "num_iterations 200");
  EXPECT_EQ(DescribeEffort(Busy({{"own_limit", "10"}})), "own rule, rounds 3");
  EstimatorSpec spec = Busy();
  spec.budget_ms = 2.5;
  EXPECT_EQ(DescribeEffort(spec), "2.5 ms a call (rounds 3)");
}

}  // namespace
}  // namespace rcme
